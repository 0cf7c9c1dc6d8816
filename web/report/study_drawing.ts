// Elements, SVG and canvases of the page of a study.
export type Span = [number, number];

export const find = <T extends Element = HTMLElement>(selector: string) => document.querySelector(selector) as T;

export function make<K extends keyof HTMLElementTagNameMap>(
  name: K, parent: Element, text?: string | number, attributes: Record<string, string> = {},
): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = String(text);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}
export function draw<K extends keyof SVGElementTagNameMap>(
  name: K, attributes: Record<string, string | number>, parent: Element, text?: string | number,
): SVGElementTagNameMap[K] {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  if (text !== undefined) made.textContent = String(text);
  parent.append(made);
  return made;
}

/** a canvas in the pixels of the screen; its context draws in those of the page */
export function paper(canvas: HTMLCanvasElement): [CanvasRenderingContext2D, number, number] {
  const box = canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(box.width * ratio));
  canvas.height = Math.max(1, Math.round(box.height * ratio));
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  context.scale(ratio, ratio);
  context.clearRect(0, 0, box.width, box.height);
  context.font = "11px sans-serif";
  return [context, box.width, box.height];
}
export function extent(values: (number | null)[]): Span {
  let low = Infinity, high = -Infinity;
  for (const x of values) if (x !== null) { low = Math.min(low, x); high = Math.max(high, x); }
  if (!(low < high)) return Number.isFinite(low) ? [low - 1, low + 1] : [0, 1];
  return [low, high];
}
export const tidy = (x: number) => String(Number(x.toPrecision(3)));
