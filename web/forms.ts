// Forms of sections and laws: fields for their scalars, drawing, capacities and curves.  A field changes the characters of its
// scalar and nothing else.
import type { ChangeDesc } from "@codemirror/state";
import { below } from "./completion";
import { type Editor, follow } from "./editor";
import type { Form, Numeral, Schema, Word } from "./messages";
import { made, Pictures } from "./show";

const KINDS = ["sections", "hinge_laws"], HEADS: Record<string, string> = { sections: "Section", hinge_laws: "Law" };
const NUMBER = /^[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?$/;
type Scalar = Numeral | Word;
type Field = HTMLInputElement | HTMLSelectElement;

/** `sections.NAME` of a path below it, empty if it is none. */
function owner(path: string): string {
  const [kind = "", name = ""] = path.split(/[.[]/);
  return KINDS.includes(kind) && name ? `${kind}.${name}` : "";
}

export class Forms {
  private scalars = new Map<string, Scalar>();
  private fields = new Map<string, Field>();
  private shown = new Map<string, HTMLElement>();
  private layout = "";
  private pictures = new Pictures();

  /** @param begun called before the first change of a field */
  constructor(private parent: HTMLElement, private editor: Editor, private schema: () => Schema | null, private begun: () => void) {}

  /** Scalars of the text as it is now. */
  set(numerals: Numeral[], words: Word[]): void {
    const all = [...words, ...numerals].filter((one) => owner(one.path)).sort((a, b) => a.start - b.start);
    // copies: the sliders move the places of their own
    this.scalars = new Map(all.map((one) => [one.path, { ...one }]));
    const layout = all.map((one) => `${one.path} ${"unit" in one ? one.unit : this.options(one).join()}`).join("\n");
    if (layout !== this.layout) this.build(all);
    this.layout = layout;
    const text = this.editor.text;
    for (const [path, field] of this.fields) {
      const one = this.scalars.get(path);
      if (one && field !== document.activeElement) field.value = text.slice(one.start, one.end);
    }
  }

  /** The text changed: places move with it, and fields of scalars that were replaced do nothing until the answer comes. */
  moved(changes: ChangeDesc): void {
    for (const [path, one] of this.scalars) if (!follow(one, changes)) this.scalars.delete(path);
  }

  /** Drawings, capacities and curves. */
  show(forms: Form[]): void {
    this.pictures.begin();
    for (const place of this.shown.values()) place.replaceChildren();
    for (const form of forms) {
      const place = this.shown.get(form.path);
      if (!place) continue;
      if (form.title) made("p", form.title, place, "note");
      if (form.drawing) made("div", "", place, "drawing").append(this.pictures.image(form.drawing, `${form.path}: drawing and capacities`));
      if (form.rows.length) {
        const table = made("dl", "", place, "values");
        for (const [name, value] of form.rows) {
          const pair = made("div", "", table);
          made("dt", name, pair);
          made("dd", value, pair);
        }
      }
      for (const curve of form.curves) {
        const figure = made("figure", "", place);
        figure.append(this.pictures.image(curve.svg, `${form.path}: law`));
        made("figcaption", curve.caption, figure);
      }
    }
    this.pictures.end();
  }

  private options(word: Word): string[] {
    const root = this.schema();
    if (!root) return [];
    const texts = below(root, word.path.split(".")).flatMap((one) => [...(one.enum ?? []), ...(one.const === undefined ? [] : [one.const])]);
    return [...new Set(texts.map(String))];
  }

  private build(all: Scalar[]): void {
    const open = new Set([...this.parent.querySelectorAll<HTMLElement>("details[open]")].map((one) => one.dataset.path));
    this.fields.clear();
    this.shown.clear();
    this.parent.replaceChildren();
    for (const path of new Set(all.map((one) => owner(one.path)))) {
      const [kind = "", name = ""] = path.split(".");
      const group = document.createElement("details"), fields = document.createElement("div");
      group.dataset.path = path;
      group.open = open.has(path);
      made("summary", `${HEADS[kind] ?? kind} ${name}`, group);
      fields.className = "fields";
      for (const one of all) if (owner(one.path) === path) this.row(one, one.path.slice(path.length + 1), fields);
      group.append(fields);
      this.shown.set(path, made("div", "", group));
      this.parent.append(group);
    }
  }

  private row(one: Scalar, name: string, parent: HTMLElement): void {
    const label = made("label", "", parent), number = "unit" in one, choices = number ? [] : this.options(one);
    made("span", name.replaceAll("_", " "), label);
    // another type has other keys: that is for the text
    if (!number && (name === "type" || choices.length < 2)) { made("output", one.text, label); return; }
    const field: Field = document.createElement(number ? "input" : "select");
    if (field instanceof HTMLSelectElement) field.append(...choices.map((text) => new Option(text, text)));
    else Object.assign(field, { type: "text", inputMode: "decimal", autocomplete: "off", spellcheck: false });
    field.setAttribute("aria-label", one.path);
    field.dataset.path = one.path;
    label.append(field);
    if (number && one.unit) made("output", one.unit, label);
    this.fields.set(one.path, field);
    let first = true;
    field.addEventListener("input", () => {
      const text = field.value.trim(), wrong = number && !NUMBER.test(text);
      field.setAttribute("aria-invalid", String(wrong));
      const now = this.scalars.get(one.path);
      if (wrong || !now) return;
      if (first) this.begun();
      this.editor.put(now.start, now.end, text, first);
      first = false;
    });
    field.addEventListener("blur", () => {
      first = true;
      const now = this.scalars.get(one.path);
      if (now) field.value = this.editor.text.slice(now.start, now.end);
      field.setAttribute("aria-invalid", "false");
    });
  }
}
