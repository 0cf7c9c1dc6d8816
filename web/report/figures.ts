// Figures: the time shown by the viewer as a line in every curve over time; SVG, PNG and data of each figure as files.
import { fileButtons } from "./files";

const cursors: { line: SVGLineElement; left: number; right: number; start: number; end: number }[] = [];

document.querySelectorAll<SVGSVGElement>("figure svg").forEach((svg) => {
  const name = (svg.getAttribute("aria-labelledby") || "figure").replace(/-title$/, ""), data = svg.dataset.csv;
  svg.parentElement?.append(fileButtons(name, () => svg, data ? () => data : undefined));
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
