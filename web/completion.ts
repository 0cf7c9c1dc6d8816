// Keys and values that may stand at the cursor, from the schema of the input and the indents above it.
import type { CompletionContext, CompletionResult } from "@codemirror/autocomplete";
import type { Schema } from "./messages";

/** Alternatives of a schema, with references followed. */
function branches(schema: Schema | undefined, root: Schema, depth = 0): Schema[] {
  if (!schema || depth > 8) return [];
  if (schema.$ref) return branches(root.$defs?.[schema.$ref.split("/").pop() ?? ""], root, depth + 1);
  const parts = [...(schema.anyOf ?? []), ...(schema.oneOf ?? []), ...(schema.allOf ?? [])];
  return [schema, ...parts.flatMap((part) => branches(part, root, depth + 1))];
}

/** What may stand below a path of keys; a step into a list is "-". */
export function below(root: Schema, path: string[]): Schema[] {
  let found = branches(root, root);
  for (const key of path) {
    found = found.flatMap((schema) => {
      if (key === "-") return branches(schema.items, root);
      if (schema.properties && key in schema.properties) return branches(schema.properties[key], root);
      const other = schema.additionalProperties;
      return typeof other === "object" ? branches(other, root) : [];
    });
  }
  return found;
}

/** Keys above a line, the outermost first, from the indents. */
export function pathAbove(lines: string[], indent: number): string[] {
  const path: string[] = [];
  let edge = indent;
  for (let i = lines.length - 1; i >= 0 && edge > 0; i--) {
    const match = /^( *)((?:- +)*)("[^"]*"|'[^']*'|[\w.-]+):(?: |$)/.exec(lines[i] ?? "");
    if (!match) continue;
    const dashes = match[2] ?? "", at = (match[1] ?? "").length + dashes.length;
    if (at >= edge) continue;
    path.unshift((match[3] ?? "").replace(/^["']|["']$/g, ""));
    edge = at;
    if (dashes) {
      path.unshift("-");
      edge = (match[1] ?? "").length;
    }
  }
  return path;
}

export function complete(schema: () => Schema | null) {
  return (context: CompletionContext): CompletionResult | null => {
    const root = schema(), line = context.state.doc.lineAt(context.pos), before = line.text.slice(0, context.pos - line.from);
    if (!root || before.includes("#")) return null;
    const above = context.state.doc.sliceString(0, line.from).split("\n");
    const value = /^( *)((?:- +)?)([\w.-]+): +([\w.-]*)$/.exec(before);
    if (value) {
      const path = pathAbove(above, (value[1] ?? "").length + (value[2] ?? "").length);
      const texts = below(root, [...path, value[3] ?? ""]).flatMap((one) => [...(one.enum ?? []), ...(one.const === undefined ? [] : [one.const])]);
      const options = [...new Set(texts.map(String))].map((label) => ({ label, type: "enum" }));
      return options.length ? { from: context.pos - (value[4] ?? "").length, options } : null;
    }
    // a key at the beginning of a line, or after a brace or a comma in braces
    const block = /^( *)((?:- +)?)([\w.-]*)$/.exec(before), flow = /^( *)((?:- +)?)([\w.-]+): *\{(?:.*, *| *)([\w.-]*)$/.exec(before);
    const match = block ?? flow;
    if (!match || (!context.explicit && !match[match.length - 1])) return null;
    const column = (match[1] ?? "").length + (match[2] ?? "").length;
    const path = [...pathAbove(above, column), ...(block ? (match[2] ? ["-"] : []) : [match[3] ?? ""])];
    const keys = new Map<string, string>();
    for (const one of below(root, path)) {
      for (const [key, inner] of Object.entries(one.properties ?? {})) keys.set(key, inner.description ?? "");
    }
    const options = [...keys].map(([label, info]) => ({ label, apply: `${label}: `, type: "property", ...(info ? { info } : {}) }));
    const typed = match[match.length - 1] ?? "";
    return options.length ? { from: context.pos - typed.length, options } : null;
  };
}
