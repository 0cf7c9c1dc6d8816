// Buttons below a figure that save it as SVG, PNG and CSV.
const SHARP = 4; // pixels of a PNG per point of the figure: 288 per inch
const STYLED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-family"];

function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function standalone(svg: SVGSVGElement): SVGSVGElement {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  // the rules of the page do not go with the file; matplotlib's shapes have a style of their own
  const shapes = "line, polyline, polygon, rect, text", copies = copy.querySelectorAll(shapes);
  svg.querySelectorAll(shapes).forEach((shape, i) => {
    if (shape.hasAttribute("style")) return;
    const style = getComputedStyle(shape);
    for (const name of STYLED) {
      const value = style.getPropertyValue(name);
      if (value) copies[i].setAttribute(name, value);
    }
  });
  copy.querySelectorAll(".time-cursor, .cursor").forEach((line) => line.remove());
  return copy;
}

// an SVG as the source of an image fetches nothing, and a data address is what the page's policy allows
function savePicture(svg: SVGSVGElement, name: string): void {
  const copy = standalone(svg), { width, height } = svg.viewBox.baseVal;
  copy.setAttribute("width", String(SHARP * width));
  copy.setAttribute("height", String(SHARP * height));
  const image = new Image();
  image.addEventListener("load", () => {
    const canvas = document.createElement("canvas");
    canvas.width = Math.round(SHARP * width);
    canvas.height = Math.round(SHARP * height);
    const brush = canvas.getContext("2d");
    if (!brush) return;
    brush.fillStyle = "#fff";
    brush.fillRect(0, 0, canvas.width, canvas.height);
    brush.drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob((blob) => { if (blob) save(blob, name); }, "image/png");
  });
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
}

/** rows as text, numbers with six digits; an absent number is an empty cell */
export function csv(rows: (string | number | null)[][]): string {
  const cell = (x: string | number | null) => {
    if (typeof x === "number") return String(Number.isInteger(x) ? x : Number(x.toPrecision(6)));
    return x && /[",\n]/.test(x) ? `"${x.replaceAll('"', '""')}"` : x ?? "";
  };
  return rows.map((row) => `${row.map(cell).join(",")}\n`).join("");
}

/** buttons for a figure as it is when they are pressed; without `data` there is no CSV */
export function fileButtons(title: string, figure: () => SVGSVGElement, data?: () => string): HTMLElement {
  const tools = document.createElement("div"), name = title.replace(/[^\p{L}\p{N}._-]+/gu, "_");
  tools.className = "tools";
  const add = (label: string, action: () => void) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = label;
    button.addEventListener("click", action);
    tools.append(button);
  };
  add("SVG", () => {
    const text = `<?xml version="1.0" encoding="utf-8"?>\n${new XMLSerializer().serializeToString(standalone(figure()))}`;
    save(new Blob([text], { type: "image/svg+xml" }), `${name}.svg`);
  });
  add("PNG", () => savePicture(figure(), `${name}.png`));
  if (data) add("CSV", () => save(new Blob([data()], { type: "text/csv" }), `${name}.csv`));
  return tools;
}
