// The text, which is the only state: CodeMirror with mistakes at their lines.
import type * as Parts from "./codemirror.entry";
import type { ChangeDesc, EditorState } from "@codemirror/state";
import type { EditorView } from "@codemirror/view";
import { complete } from "./completion";
import type { Problem, Schema } from "./messages";

declare const CodeMirror: typeof Parts;

export interface Events {
  /** The text changed; `whole` if it was replaced by another file. */
  changed(changes: ChangeDesc, whole: boolean): void;
  moved(): void;
  save(): void;
}

/**
 * Move a place of the text with a change.
 * @returns whether it still has what it had: false if more than it was replaced
 */
export function follow(place: { start: number; end: number }, changes: ChangeDesc): boolean {
  let kept = true;
  changes.iterChangedRanges((from, to) => {
    if (from < place.end && to > place.start && (from < place.start || to > place.end)) kept = false;
  });
  place.start = changes.mapPos(place.start, -1);
  place.end = changes.mapPos(place.end, 1);
  return kept;
}

export class Editor {
  readonly view: EditorView;
  schema: Schema | null = null;
  private whole = false;

  constructor(parent: HTMLElement, nonce: string, private events: Events) {
    this.view = new CodeMirror.EditorView({ parent, state: this.state("", nonce) });
  }

  private state(doc: string, nonce: string): EditorState {
    const C = CodeMirror;
    return C.EditorState.create({
      doc,
      extensions: [
        C.EditorView.cspNonce.of(nonce), C.lineNumbers(), C.lintGutter(), C.history(), C.drawSelection(),
        C.indentUnit.of("  "), C.yaml(), C.syntaxHighlighting(C.defaultHighlightStyle), C.bracketMatching(),
        C.highlightActiveLine(), C.highlightActiveLineGutter(), C.highlightSelectionMatches(),
        C.autocompletion({ override: [complete(() => this.schema)] }),
        C.keymap.of([
          { key: "Mod-s", run: () => { this.events.save(); return true; } },
          ...C.completionKeymap, ...C.searchKeymap, ...C.historyKeymap, ...C.defaultKeymap,
        ]),
        C.EditorView.contentAttributes.of({ "aria-label": "Input" }),
        C.EditorView.updateListener.of((update) => {
          if (update.docChanged) this.events.changed(update.changes.desc, this.whole);
          if (update.docChanged || update.selectionSet) this.events.moved();
        }),
      ],
    });
  }

  get text(): string { return this.view.state.doc.toString(); }

  get cursor(): number { return this.view.state.selection.main.head; }

  /** Another text; undo leads back to the one before. */
  replace(text: string): void {
    this.whole = true;
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, selection: { anchor: 0 }, scrollIntoView: true });
    this.whole = false;
  }

  /** Replace a few characters; those of one drag are undone together. */
  put(from: number, to: number, insert: string, first: boolean): void {
    this.view.dispatch({
      changes: { from, to, insert },
      annotations: [
        CodeMirror.Transaction.userEvent.of(first ? "input.slider.start" : "input.slider"),
        CodeMirror.Transaction.addToHistory.of(true),
      ],
    });
  }

  show(problems: Problem[]): void {
    const doc = this.view.state.doc;
    const diagnostics = problems.filter((one) => one.line >= 1 && one.line <= doc.lines).map((one) => {
      const line = doc.line(one.line), details = [one.came && `given: ${one.came}`, one.allowed && `allowed: ${one.allowed}`, one.todo];
      const start = line.from + (line.text.length - line.text.trimStart().length);
      return {
        from: start, to: Math.max(line.to, start), severity: "error" as const,
        message: [one.what, ...details].filter(Boolean).join("\n"),
      };
    });
    this.view.dispatch(CodeMirror.setDiagnostics(this.view.state, diagnostics));
  }

  go(line: number): void {
    const at = this.view.state.doc.line(Math.min(Math.max(line, 1), this.view.state.doc.lines)).from;
    this.view.dispatch({ selection: { anchor: at }, scrollIntoView: true });
    this.view.focus();
  }
}
