// The page of `crumple app`: input left, answer right.  The text of the editor is the only state.
import { Editor } from "./editor";
import { Forms } from "./forms";
import type { Answer, Curve, Received } from "./messages";
import { Connection } from "./socket";
import { Curves, Figures, list, say } from "./show";
import { Sliders } from "./sliders";
import type { Header, Scene } from "./report/scene";
import type {} from "./report/viewer";

declare global { interface Window { crumpleApp: object } }

const TYPED = 150;  // without a key until the text is solved [ms]
const DRAFT = 1000;  // without a change until a draft is written [ms]
const BURST = 2000;  // without a change after which the answer becomes the one before [ms]

const find = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const [files, starts, name, save, title, banner, refusal] = [
  find<HTMLSelectElement>("files"), find<HTMLSelectElement>("starts"), find<HTMLInputElement>("name"), find<HTMLButtonElement>("save"),
  find("file-state"), find("banner"), find("refusal"),
];
const [check, cancel, bar, beside, draft] = [
  find<HTMLButtonElement>("check"), find<HTMLButtonElement>("cancel"), find<HTMLProgressElement>("share"), find<HTMLSelectElement>("beside"), find("draft"),
];
const curves = new Curves(find("curves"), find("band")), figures = new Figures(find("figures"));

let seen = "", saved = "", first = "", asked = 0, answered = 0, waiting = false, wantsNumbers = true;
let shown: Scene | null = null, before: Scene | undefined, curvesBefore: Curve[] = [], changed = -Infinity;
let typing = 0, keeping = 0, keptDraft: string | null = null, drafted = false, besideNames: string[] = [];
const told: number[] = [];  // milliseconds from question to drawn answer, for scripts

const nonce = document.querySelector<HTMLMetaElement>("meta[name=style-nonce]")?.content ?? "";
const connection = new Connection(receive, (what) => { banner.textContent = what; banner.hidden = !what; });
const editor = new Editor(find("editor"), nonce, {
  changed(changes, whole) {
    sliders.moved(changes);
    forms.moved(changes);
    const now = performance.now();
    if (!sliders.dragging && now - changed > BURST) remember();
    if (whole) { before = undefined; curvesBefore = []; }
    changed = now;
    state();
    clearTimeout(typing);
    typing = 0;
    if (sliders.dragging || whole) ask(!sliders.dragging);
    else typing = window.setTimeout(() => { typing = 0; ask(true); }, TYPED);
    clearTimeout(keeping);
    keeping = window.setTimeout(keep, DRAFT);
  },
  moved() { sliders.draw(); },
  save: store,
});
const sliders = new Sliders(find("sliders"), find<HTMLInputElement>("filter"), editor, remember, () => ask(true));
const forms = new Forms(find("forms"), editor, () => editor.schema, remember);

/** the present answer becomes the one before */
function remember(): void {
  before = shown ?? undefined;
  curvesBefore = curves.shown;
}

function state(): void {
  const dirty = editor.text !== saved;
  title.textContent = dirty ? "not saved" : seen ? "saved" : "";
  document.title = `${dirty ? "• " : ""}${name.value || "new input"} · Crumple`;
}

/** one question at a time is under way; the newest text follows it */
let questioned = 0;
function ask(numbers: boolean): void {
  wantsNumbers ||= numbers;
  if (waiting) { asked++; return; }
  const besides = besideNames.length > 0;
  const sent = connection.send({
    kind: besides ? "beside" : "solve", number: ++asked, name: name.value, text: editor.text, numbers: wantsNumbers, quick: sliders.dragging,
    names: besideNames,
  });
  waiting = sent;
  questioned = performance.now();
  if (sent) { answered = asked; wantsNumbers = false; }
}

/** writes a draft of what is not saved, and removes this window's draft when undo has led back to what is */
function keep(): void {
  const dirty = editor.text !== saved;
  if (dirty) connection.send({ kind: "draft", name: name.value, text: editor.text });
  else if (drafted) connection.send({ kind: "discard", name: name.value });
  drafted = dirty;
}

function store(): void {
  refusal.hidden = true;
  if (!name.value) { name.focus(); refuse("give the file a name that ends with .yaml"); return; }
  connection.send({ kind: "save", name: name.value, text: editor.text, seen: name.value === first ? seen : "" });
}

function refuse(what: string): void {
  refusal.textContent = what;
  refusal.hidden = false;
}

/** answers are drawn one after another, in their order */
let drawing = 0, last: Promise<void> = Promise.resolve();
function draw(answer: Answer, live: boolean): Promise<void> {
  drawing++;
  last = last.catch(() => undefined).then(() => drawNow(answer, live)).finally(() => { drawing--; });
  return last;
}

async function drawNow(answer: Answer, live: boolean): Promise<void> {
  if (!answer.scene) return;
  const old = live ? before : undefined;
  const header = JSON.parse(answer.scene.header) as Header, names = header.models.map((model) => model.name);
  shown = await window.crumplePlayer.show(header, answer.scene.payload, old);
  find("models").replaceChildren(...(names.length > 1 ? names : []).map((text) => Object.assign(document.createElement("span"), { textContent: text })));
  find("nothing").hidden = true;
}

async function answer(message: Answer & { number: number }): Promise<void> {
  waiting = false;
  if (asked !== answered) ask(false);
  const problems = message.problems ?? [];
  list(find("problems"), problems, message.more ?? 0, (line) => editor.go(line));
  editor.show(problems);
  if (message.numbers) {
    // places are those of the text that was sent
    if (asked === message.number) { sliders.set(message.numbers); forms.set(message.numbers, message.words ?? []); }
    else wantsNumbers = true;
  }
  document.body.classList.toggle("stale", problems.length > 0 || !!message.failed);
  if (problems.length || message.stopped) return;
  say(find("said"), message);
  curves.show(message, curvesBefore);
  await draw(message, true);
  told.push(performance.now() - questioned);
}

function receive(message: Received): void {
  switch (message.kind) {
    case "welcome":
      find("folder").textContent = message.folder;
      fill(files, message.files, "Open …");
      fill(beside, message.files, "Beside …");
      fill(starts, message.starts.map((one) => [one.name, one.title]), "New from …");
      editor.schema = message.schema;
      waiting = false;
      // after a lost connection the text is kept
      if (editor.text) ask(true);
      else if (message.first) connection.send({ kind: "open", name: message.first });
      else connection.send({ kind: "start", name: message.starts.find((one) => one.name === "tube_bending")?.name ?? "" });
      break;
    case "opened":
      refusal.hidden = true;
      [seen, saved, first, name.value] = [message.seen, message.seen ? message.text : "", message.name, message.name];
      besideNames = [];
      keptDraft = message.draft !== null && message.draft !== message.text ? message.draft : null;
      draft.hidden = keptDraft === null;
      drafted = false;
      editor.replace(message.text);
      state();
      break;
    case "answer":
      void answer(message);
      break;
    case "figures":
      if (message.number === asked) figures.show(message.figures ?? []);
      break;
    case "forms":
      if (message.number === asked) forms.show(message.forms ?? []);
      break;
    case "bands":
      if (message.number === asked) curves.band(message.bands ?? null);
      break;
    case "saved":
      [seen, saved, first] = [message.seen, editor.text, message.name];
      draft.hidden = true;
      fill(files, message.files, "Open …");
      fill(beside, message.files, "Beside …");
      state();
      break;
    case "progress":
      bar.value = message.share;
      break;
    case "shell":
      checked(message);
      break;
    case "code":
      find<HTMLAnchorElement>("window").href = `/#${message.code}`;
      find<HTMLAnchorElement>("window").hidden = false;
      break;
    case "refused":
      if (message.of === "solve" || message.of === "beside") waiting = false;
      if (message.of === "shell") running(false);
      refuse(message.what);
      break;
    default:
      break;
  }
}

function checked(message: Answer): void {
  running(false);
  const problems = message.problems ?? [];
  if (message.stopped) { refuse("the shell check was cancelled"); return; }
  if (problems.length) { list(find("problems"), problems, message.more ?? 0, (line) => editor.go(line)); return; }
  say(find("checked"), message);
  find("checked").hidden = false;
  void draw(message, false);
}

function running(now: boolean): void {
  check.disabled = now;
  bar.hidden = cancel.hidden = !now;
  bar.value = 0;
}

function fill(select: HTMLSelectElement, entries: (string | [string, string])[], head: string): void {
  select.replaceChildren(new Option(head, ""), ...entries.map((one) => (typeof one === "string" ? new Option(one, one) : new Option(one[1], one[0]))));
}

/** whether a text that is not saved may be replaced; its draft stays, and undo leads back */
function chosen(select: HTMLSelectElement, kind: string): void {
  select.addEventListener("change", () => {
    if (!select.value) return;
    keep();
    connection.send({ kind, name: select.value });
    select.value = "";
  });
}

chosen(files, "open");
chosen(starts, "start");
save.addEventListener("click", store);
name.addEventListener("input", state);
check.addEventListener("click", () => {
  refusal.hidden = true;
  if (connection.send({ kind: "shell", name: name.value, text: editor.text })) running(true);
});
cancel.addEventListener("click", () => connection.send({ kind: "cancel" }));
beside.addEventListener("change", () => {
  besideNames = beside.value ? [...new Set([...besideNames, beside.value])].slice(-3) : [];
  beside.value = "";
  find("alone").hidden = !besideNames.length;
  ask(false);
});
find("alone").addEventListener("click", () => {
  besideNames = [];
  find("alone").hidden = true;
  ask(false);
});
find("new-window").addEventListener("click", () => connection.send({ kind: "code" }));
find("window").addEventListener("click", () => { find("window").hidden = true; });
find("restore").addEventListener("click", () => {
  if (keptDraft !== null) editor.replace(keptDraft);
  draft.hidden = true;
});
find("discard").addEventListener("click", () => {
  connection.send({ kind: "discard", name: name.value });
  draft.hidden = true;
});
document.addEventListener("keydown", (event) => {
  if (event.key !== "s" || !(event.ctrlKey || event.metaKey) || event.defaultPrevented) return;
  event.preventDefault();
  store();
});
// nothing is asked when the page goes: what was not saved is in the draft
window.addEventListener("pagehide", keep);

window.crumpleApp = { editor, told, get idle() { return !typing && !waiting && asked === answered && !drawing; } };
void connection.begin().catch(() => { banner.textContent = "The server does not answer. Start it again: crumple app"; banner.hidden = false; });
