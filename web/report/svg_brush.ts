// What draws a figure on a canvas draws it as SVG with this, in the same pixels.
import { draw } from "./study_drawing";

/** what of a canvas's context the figures use */
export type Brush = Pick<CanvasRenderingContext2D, "beginPath" | "moveTo" | "lineTo" | "arc" | "stroke" | "fill" | "strokeRect" | "fillRect" | "fillText"
  | "strokeStyle" | "fillStyle" | "lineWidth" | "globalAlpha" | "textAlign">;

const FONT = { "font-size": 11, "font-family": "sans-serif" };
const round = (x: number) => Number(x.toFixed(2));

export class SvgBrush implements Brush {
  readonly svg: SVGSVGElement;
  strokeStyle: Brush["strokeStyle"] = "#000";
  fillStyle: Brush["fillStyle"] = "#000";
  lineWidth = 1;
  globalAlpha = 1;
  textAlign: CanvasTextAlign = "left";
  private path = "";
  private readonly measure = document.createElement("canvas").getContext("2d") as CanvasRenderingContext2D;

  constructor(canvas: HTMLCanvasElement, readonly wide = canvas.clientWidth, readonly tall = canvas.clientHeight) {
    this.svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.svg.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
    this.measure.font = `${FONT["font-size"]}px ${FONT["font-family"]}`;
  }
  beginPath(): void { this.path = ""; }
  moveTo(x: number, y: number): void { this.path += `M${round(x)} ${round(y)}`; }
  lineTo(x: number, y: number): void { this.path += `L${round(x)} ${round(y)}`; }
  /** a full circle, whatever the angles */
  arc(x: number, y: number, radius: number): void {
    const r = round(radius);
    this.path += `M${round(x - r)} ${round(y)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
  }
  stroke(): void { draw("path", { d: this.path, ...this.outline() }, this.svg); }
  fill(): void { draw("path", { d: this.path, ...this.inside() }, this.svg); }
  strokeRect(x: number, y: number, width: number, height: number): void { draw("rect", { x, y, width, height, ...this.outline() }, this.svg); }
  fillRect(x: number, y: number, width: number, height: number): void { draw("rect", { x, y, width, height, ...this.inside() }, this.svg); }
  fillText(text: string, x: number, y: number, most = Infinity): void {
    const anchor = ({ center: "middle", right: "end" } as Record<string, string>)[this.textAlign] ?? "start";
    const narrow: Record<string, string | number> = this.measure.measureText(text).width > most ? { textLength: most, lengthAdjust: "spacingAndGlyphs" } : {};
    draw("text", { x, y, "text-anchor": anchor, ...FONT, ...this.inside(), ...narrow }, this.svg, text);
  }
  private outline() { return { fill: "none", stroke: String(this.strokeStyle), "stroke-width": this.lineWidth, opacity: this.globalAlpha }; }
  private inside() { return { fill: String(this.fillStyle), opacity: this.globalAlpha }; }
}
