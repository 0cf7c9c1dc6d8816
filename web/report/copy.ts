// A button beside each table puts it on the clipboard, cells apart by tabs; what is folded away is printed.
export {};

addEventListener("beforeprint", () => { for (const part of document.querySelectorAll("details")) part.open = true; });
for (const table of document.querySelectorAll("table")) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "copy";
  button.textContent = "Copy table";
  button.addEventListener("click", () => {
    const rows = [...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent.trim()).join("\t"));
    const text = document.createElement("textarea");
    text.value = rows.join("\n");
    document.body.append(text);
    text.select();
    const done = document.execCommand("copy");
    text.remove();
    button.textContent = done ? "Copied" : "Select and copy by hand";
    setTimeout(() => { button.textContent = "Copy table"; }, 1500);
  });
  table.parentElement?.after(button);
}
