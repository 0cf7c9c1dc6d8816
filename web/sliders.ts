// A slider for every number of the text: it changes the digits of that number and nothing else.
import type { ChangeDesc } from "@codemirror/state";
import { type Editor, follow } from "./editor";
import type { Numeral } from "./messages";

const MOST = 40;  // sliders that are shown
const STEPS = 200;

/** Number as it is written: four digits, without an exponent where that is short. */
export function written(value: number): string {
  const text = Number(value.toPrecision(4)).toString();
  return text.includes("e") ? value.toPrecision(4).replace(/\.?0+e/, "e") : text;
}

/** Lowest and highest value of the slider of a number. */
export function range(value: number): [number, number] {
  if (value === 0) return [-1, 1];
  return value > 0 ? [0.5 * value, 1.5 * value] : [1.5 * value, 0.5 * value];
}

export class Sliders {
  private numerals: Numeral[] = [];
  private dragged = "";

  constructor(private list: HTMLElement, private filter: HTMLInputElement, private editor: Editor, private begun: () => void,
    private ended: () => void) {
    filter.addEventListener("input", () => this.draw());
  }

  get dragging(): boolean { return this.dragged !== ""; }

  /** Numbers of the text as it is now. */
  set(numerals: Numeral[]): void {
    if (this.dragging) return;
    this.numerals = numerals;
    this.draw();
  }

  /** The text changed: places move with it, and numbers that were replaced have no slider until the answer comes. */
  moved(changes: ChangeDesc): void {
    this.numerals = this.numerals.filter((one) => follow(one, changes));
  }

  /** The number at the cursor comes first. */
  draw(): void {
    if (this.dragging) return;
    const wanted = this.filter.value.trim().toLowerCase(), cursor = this.editor.cursor;
    const line = this.editor.view.state.doc.lineAt(cursor);
    const here = (one: Numeral) => Number(one.start >= line.from && one.end <= line.to) + Number(one.start <= cursor && cursor <= one.end);
    const shown = this.numerals.filter((one) => one.path.toLowerCase().includes(wanted));
    shown.sort((a, b) => here(b) - here(a));
    this.list.replaceChildren(...shown.slice(0, MOST).map((one) => this.row(one)));
    if (shown.length > MOST) {
      const rest = document.createElement("p");
      rest.className = "note";
      rest.textContent = `${shown.length - MOST} more: type a part of the name above.`;
      this.list.append(rest);
    }
  }

  private row(one: Numeral): HTMLElement {
    const label = document.createElement("label"), name = document.createElement("span");
    const input = document.createElement("input"), output = document.createElement("output");
    const [low, high] = range(one.value);
    name.textContent = one.path;
    output.textContent = `${written(one.value)} ${one.unit}`;
    Object.assign(input, { type: "range", min: low, max: high, step: (high - low) / STEPS, value: one.value });
    input.setAttribute("aria-label", one.path);
    input.dataset.path = one.path;
    const ended = () => {
      if (!this.dragging) return;
      this.dragged = "";
      this.ended();
    };
    input.addEventListener("input", () => {
      if (!this.numerals.includes(one)) return;
      const first = this.dragged !== one.path;
      if (first) this.begun();
      this.dragged = one.path;
      const text = written(Number(input.value));
      this.editor.put(one.start, one.end, text, first);
      output.textContent = `${text} ${one.unit}`;
      input.setAttribute("aria-valuetext", output.textContent);
    });
    input.addEventListener("change", ended);
    input.addEventListener("blur", ended);
    label.append(name, input, output);
    return label;
  }
}
