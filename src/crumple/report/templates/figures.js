// Figures: the time shown by the viewer as a line in every curve over time; SVG and data of each figure as files.
"use strict";
(() => {
  const cursors = [];

  function save(text, type, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  document.querySelectorAll("figure > svg").forEach((svg) => {
    const name = (svg.getAttribute("aria-labelledby") || "figure").replace(/-title$/, "");
    const tools = document.createElement("div");
    tools.className = "tools";
    const add = (label, action) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      button.addEventListener("click", action);
      tools.append(button);
    };
    add("SVG", () => {
      const copy = svg.cloneNode(true);
      copy.querySelectorAll(".time-cursor").forEach((line) => line.remove());
      save(`<?xml version="1.0" encoding="utf-8"?>\n${new XMLSerializer().serializeToString(copy)}`, "image/svg+xml", `${name}.svg`);
    });
    if (svg.dataset.csv) add("CSV", () => save(svg.dataset.csv, "text/csv", `${name}.csv`));
    svg.parentElement.append(tools);
    // axes over time: left, right, top, bottom in the picture, and the times [s] at left and right
    for (const [left, right, top, bottom, start, end] of JSON.parse(svg.dataset.time || "[]")) {
      const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
      line.setAttribute("class", "time-cursor");
      line.setAttribute("y1", top);
      line.setAttribute("y2", bottom);
      line.style.display = "none";
      svg.append(line);
      cursors.push({ line, left, right, start, end });
    }
  });

  document.addEventListener("crumple-time", (event) => {
    for (const { line, left, right, start, end } of cursors) {
      const x = left + (right - left) * (event.detail - start) / (end - start);
      line.style.display = x < left - 0.5 || x > right + 0.5 ? "none" : "";
      line.setAttribute("x1", x);
      line.setAttribute("x2", x);
    }
  });
})();
