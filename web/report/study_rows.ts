// Rows of a study as the page has them: their columns as numbers, which keep all constraints, and how values are told.
import type { Header } from "./scene";
import { extent, find, tidy } from "./study_drawing";
import type { Convergence, Effect } from "./study_bars";

interface Column { name: string; unit: string; kind: string; words?: boolean; values: (number | string | null)[]; levels?: string[] }
/** as src/crumple/study/page_data.py writes it */
interface Data {
  columns: Column[]; rows: number[]; status: string[]; front: number[]; best: number | null; alike: Record<number, string>;
  limits: { name: string; low: number | null; high: number | null }[]; goals: { name: string }[]; effects: Effect[]; convergence: Convergence[];
}

export const data = JSON.parse(find("#study-data").textContent ?? "") as Data;
const shapes = JSON.parse(find("#study-shapes").textContent ?? "") as Record<string, { header: Header; payload: string } | undefined>;
export const { columns, rows, status } = data, count = rows.length, axes = [...columns.keys()];
export const KEPT = "#1f5f9e", VIOLATED = "#d08a3c", FRONT = "#2a7d61", CHOSEN = "#c1272d", FAINT = "rgba(120,130,140,0.12)";
export const numbers: (number | null)[][] = columns.map((c) => (c.words ? encode(c) : c.values as (number | null)[]));
/** value of a row that has all */
export const at = (k: number, i: number) => numbers[k][i] as number;
export const complete = rows.map((_, i) => columns.every((c) => c.values[i] !== null));
export const kept = rows.map((_, i) => complete[i] && data.limits.every(({ name, low, high }) => {
  const x = columns.find((c) => c.name === name)?.values[i] as number;
  return (low === null || x >= low) && (high === null || x <= high);
}));
const place = new Map(rows.map((row, i) => [row, i]));
export const front = data.front.map((row) => place.get(row)).filter((i) => i !== undefined);
export const onFront = new Set(front), best = data.best === null ? undefined : place.get(data.best), range = numbers.map(extent);

/** names as numbers: the places of their first occurrence */
function encode(column: Column): number[] {
  const levels = [...new Set(column.values as string[])];
  column.levels = levels;
  return (column.values as string[]).map((word) => levels.indexOf(word));
}
export const label = (k: number) => columns[k].name + (columns[k].unit ? `, ${columns[k].unit}` : "");
export const told = (k: number, i: number) => {
  const x = columns[k].values[i];
  return x === null ? "none" : typeof x === "string" ? x : `${Number(x.toPrecision(5))}${columns[k].unit ? ` ${columns[k].unit}` : ""}`;
};
export const tick = (k: number, x: number) => (columns[k].words ? columns[k].levels?.[Math.round(x)] ?? "" : tidy(x));
export const colour = (i: number) => (kept[i] ? KEPT : VIOLATED);
export const shape = (i: number) => shapes[data.alike[rows[i]]];
