// Figures: the time shown by the viewer as a line in every curve over time; SVG, PNG and data of each figure as files.
export {};

const cursors: { line: SVGLineElement; left: number; right: number; start: number; end: number }[] = [];

const SHARP = 4; // pixels of a PNG per point of the figure: 288 per inch

function save(text: string, type: string, name: string): void {
  saveBlob(new Blob([text], { type }), name);
}

function saveBlob(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function standalone(svg: SVGSVGElement): SVGSVGElement {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  copy.querySelectorAll(".time-cursor").forEach((line) => line.remove());
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
    canvas.toBlob((blob) => { if (blob) saveBlob(blob, name); }, "image/png");
  });
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
}

document.querySelectorAll<SVGSVGElement>("figure svg").forEach((svg) => {
  const name = (svg.getAttribute("aria-labelledby") || "figure").replace(/-title$/, "");
  const tools = document.createElement("div");
  tools.className = "tools";
  const add = (label: string, action: () => void) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = label;
    button.addEventListener("click", action);
    tools.append(button);
  };
  add("SVG", () => {
    save(`<?xml version="1.0" encoding="utf-8"?>\n${new XMLSerializer().serializeToString(standalone(svg))}`, "image/svg+xml", `${name}.svg`);
  });
  add("PNG", () => savePicture(svg, `${name}.png`));
  const data = svg.dataset.csv;
  if (data) add("CSV", () => save(data, "text/csv", `${name}.csv`));
  svg.parentElement?.append(tools);
  // axes over time: left, right, top, bottom in the picture, and the times [s] at left and right
  for (const [left, right, top, bottom, start, end] of JSON.parse(svg.dataset.time || "[]") as number[][]) {
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    line.setAttribute("class", "time-cursor");
    line.setAttribute("y1", String(top));
    line.setAttribute("y2", String(bottom));
    line.style.display = "none";
    svg.append(line);
    cursors.push({ line, left, right, start, end });
  }
});

document.addEventListener("crumple-time", (event) => {
  for (const { line, left, right, start, end } of cursors) {
    const x = left + (right - left) * ((event as CustomEvent<number>).detail - start) / (end - start);
    line.style.display = x < left - 0.5 || x > right + 0.5 ? "none" : "";
    line.setAttribute("x1", String(x));
    line.setAttribute("x2", String(x));
  }
});
