// The way to the server: a code that works once becomes a token, which stays in the memory of this page.
import type { Received } from "./messages";

const AGAIN = 1500;  // until the next attempt after the connection ended [ms]
const TOO_MANY = 4001, NOT_ALLOWED = 4003;

export class Connection {
  private token = "";
  private socket: WebSocket | null = null;

  /** @param received takes messages @param told says how the connection is, empty if well */
  constructor(private received: (message: Received) => void, private told: (what: string) => void) {}

  async begin(): Promise<void> {
    const code = location.hash.slice(1);
    // the code is used up; nobody shall find it in the history
    history.replaceState(null, "", location.pathname);
    if (!code) {
      this.told("This page was opened without its code. Start it again: crumple app");
      return;
    }
    const answer = await fetch("/token", { method: "POST", body: code });
    if (!answer.ok) {
      this.told("This address was used already. Start again: crumple app");
      return;
    }
    this.token = ((await answer.json()) as { token: string }).token;
    this.connect();
  }

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/window`);
    this.socket = socket;
    socket.onopen = () => {
      socket.send(JSON.stringify({ token: this.token }));
      this.told("");
    };
    socket.onmessage = (event) => this.received(JSON.parse(event.data as string) as Received);
    socket.onclose = (event) => {
      this.socket = null;
      if (event.code === TOO_MANY) this.told("Too many windows are open: close one, then load this page anew.");
      else if (event.code === NOT_ALLOWED) this.told("The server was started anew. Start again: crumple app");
      else {
        this.told("The connection ended. Your text is kept here; trying again …");
        setTimeout(() => this.connect(), AGAIN);
      }
    };
  }

  /** Whether the message was sent. */
  send(message: Record<string, unknown>): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
}
