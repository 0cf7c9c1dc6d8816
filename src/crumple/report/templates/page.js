// Made from web/ by make web: change it there.
"use strict";
(() => {
  // report/files.ts
  var SHARP = 4;
  var STYLED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-family"];
  function save(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
  }
  function standalone(svg) {
    const copy = svg.cloneNode(true);
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
  function savePicture(svg, name) {
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
      canvas.toBlob((blob) => {
        if (blob) save(blob, name);
      }, "image/png");
    });
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
  }
  function fileButtons(title, figure, data) {
    const tools = document.createElement("div"), name = title.replace(/[^\p{L}\p{N}._-]+/gu, "_");
    tools.className = "tools";
    const add = (label, action) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      button.addEventListener("click", action);
      tools.append(button);
    };
    add("SVG", () => {
      const text = `<?xml version="1.0" encoding="utf-8"?>
${new XMLSerializer().serializeToString(standalone(figure()))}`;
      save(new Blob([text], { type: "image/svg+xml" }), `${name}.svg`);
    });
    add("PNG", () => savePicture(figure(), `${name}.png`));
    if (data) add("CSV", () => save(new Blob([data()], { type: "text/csv" }), `${name}.csv`));
    return tools;
  }

  // report/figures.ts
  var cursors = [];
  document.querySelectorAll("figure svg").forEach((svg) => {
    const name = (svg.getAttribute("aria-labelledby") || "figure").replace(/-title$/, ""), data = svg.dataset.csv;
    svg.parentElement?.append(fileButtons(name, () => svg, data ? () => data : void 0));
    for (const [left, right, top, bottom, start, end] of JSON.parse(svg.dataset.time || "[]")) {
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
      const x = left + (right - left) * (event.detail - start) / (end - start);
      line.style.display = x < left - 0.5 || x > right + 0.5 ? "none" : "";
      line.setAttribute("x1", String(x));
      line.setAttribute("x2", String(x));
    }
  });

  // report/copy.ts
  addEventListener("beforeprint", () => {
    for (const part of document.querySelectorAll("details")) part.open = true;
  });
  for (const table of document.querySelectorAll("table")) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "copy";
    button.textContent = "Copy table";
    button.addEventListener("click", () => {
      const rows = [...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent.trim()).join("	"));
      const text = document.createElement("textarea");
      text.value = rows.join("\n");
      document.body.append(text);
      text.select();
      const done = document.execCommand("copy");
      text.remove();
      button.textContent = done ? "Copied" : "Select and copy by hand";
      setTimeout(() => {
        button.textContent = "Copy table";
      }, 1500);
    });
    table.parentElement?.after(button);
  }
})();
