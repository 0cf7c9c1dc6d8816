// Made from web/ by make web: change it there.
"use strict";
(() => {
  // completion.ts
  function branches(schema, root, depth = 0) {
    if (!schema || depth > 8) return [];
    if (schema.$ref) return branches(root.$defs?.[schema.$ref.split("/").pop() ?? ""], root, depth + 1);
    const parts = [...schema.anyOf ?? [], ...schema.oneOf ?? [], ...schema.allOf ?? []];
    return [schema, ...parts.flatMap((part) => branches(part, root, depth + 1))];
  }
  function below(root, path) {
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
  function pathAbove(lines, indent) {
    const path = [];
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
  function complete(schema) {
    return (context) => {
      const root = schema(), line = context.state.doc.lineAt(context.pos), before2 = line.text.slice(0, context.pos - line.from);
      if (!root || before2.includes("#")) return null;
      const above = context.state.doc.sliceString(0, line.from).split("\n");
      const value = /^( *)((?:- +)?)([\w.-]+): +([\w.-]*)$/.exec(before2);
      if (value) {
        const path2 = pathAbove(above, (value[1] ?? "").length + (value[2] ?? "").length);
        const texts = below(root, [...path2, value[3] ?? ""]).flatMap((one) => [...one.enum ?? [], ...one.const === void 0 ? [] : [one.const]]);
        const options2 = [...new Set(texts.map(String))].map((label) => ({ label, type: "enum" }));
        return options2.length ? { from: context.pos - (value[4] ?? "").length, options: options2 } : null;
      }
      const block = /^( *)((?:- +)?)([\w.-]*)$/.exec(before2), flow = /^( *)((?:- +)?)([\w.-]+): *\{(?:.*, *| *)([\w.-]*)$/.exec(before2);
      const match = block ?? flow;
      if (!match || !context.explicit && !match[match.length - 1]) return null;
      const column = (match[1] ?? "").length + (match[2] ?? "").length;
      const path = [...pathAbove(above, column), ...block ? match[2] ? ["-"] : [] : [match[3] ?? ""]];
      const keys = /* @__PURE__ */ new Map();
      for (const one of below(root, path)) {
        for (const [key, inner] of Object.entries(one.properties ?? {})) keys.set(key, inner.description ?? "");
      }
      const options = [...keys].map(([label, info]) => ({ label, apply: `${label}: `, type: "property", ...info ? { info } : {} }));
      const typed = match[match.length - 1] ?? "";
      return options.length ? { from: context.pos - typed.length, options } : null;
    };
  }

  // editor.ts
  function follow(place, changes) {
    let kept = true;
    changes.iterChangedRanges((from, to) => {
      if (from < place.end && to > place.start && (from < place.start || to > place.end)) kept = false;
    });
    place.start = changes.mapPos(place.start, -1);
    place.end = changes.mapPos(place.end, 1);
    return kept;
  }
  var Editor = class {
    constructor(parent, nonce2, events) {
      this.events = events;
      this.view = new CodeMirror.EditorView({ parent, state: this.state("", nonce2) });
    }
    events;
    view;
    schema = null;
    whole = false;
    state(doc, nonce2) {
      const C = CodeMirror;
      return C.EditorState.create({
        doc,
        extensions: [
          C.EditorView.cspNonce.of(nonce2),
          C.lineNumbers(),
          C.lintGutter(),
          C.history(),
          C.drawSelection(),
          C.indentUnit.of("  "),
          C.yaml(),
          C.syntaxHighlighting(C.defaultHighlightStyle),
          C.bracketMatching(),
          C.highlightActiveLine(),
          C.highlightActiveLineGutter(),
          C.highlightSelectionMatches(),
          C.autocompletion({ override: [complete(() => this.schema)] }),
          C.keymap.of([
            { key: "Mod-s", run: () => {
              this.events.save();
              return true;
            } },
            ...C.completionKeymap,
            ...C.searchKeymap,
            ...C.historyKeymap,
            ...C.defaultKeymap
          ]),
          C.EditorView.contentAttributes.of({ "aria-label": "Input" }),
          C.EditorView.updateListener.of((update) => {
            if (update.docChanged) this.events.changed(update.changes.desc, this.whole);
            if (update.docChanged || update.selectionSet) this.events.moved();
          })
        ]
      });
    }
    get text() {
      return this.view.state.doc.toString();
    }
    get cursor() {
      return this.view.state.selection.main.head;
    }
    /** Another text; undo leads back to the one before. */
    replace(text) {
      this.whole = true;
      this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, selection: { anchor: 0 }, scrollIntoView: true });
      this.whole = false;
    }
    /** Replace a few characters; those of one drag are undone together. */
    put(from, to, insert, first2) {
      this.view.dispatch({
        changes: { from, to, insert },
        annotations: [
          CodeMirror.Transaction.userEvent.of(first2 ? "input.slider.start" : "input.slider"),
          CodeMirror.Transaction.addToHistory.of(true)
        ]
      });
    }
    show(problems) {
      const doc = this.view.state.doc;
      const diagnostics = problems.filter((one) => one.line >= 1 && one.line <= doc.lines).map((one) => {
        const line = doc.line(one.line), details = [one.came && `given: ${one.came}`, one.allowed && `allowed: ${one.allowed}`, one.todo];
        const start = line.from + (line.text.length - line.text.trimStart().length);
        return {
          from: start,
          to: Math.max(line.to, start),
          severity: "error",
          message: [one.what, ...details].filter(Boolean).join("\n")
        };
      });
      this.view.dispatch(CodeMirror.setDiagnostics(this.view.state, diagnostics));
    }
    go(line) {
      const at = this.view.state.doc.line(Math.min(Math.max(line, 1), this.view.state.doc.lines)).from;
      this.view.dispatch({ selection: { anchor: at }, scrollIntoView: true });
      this.view.focus();
    }
  };

  // show.ts
  var FULL = 300;
  var WIDE = 330;
  var TALL = 170;
  var LEFT = 46;
  var RIGHT = 10;
  var TOP = 24;
  var BOTTOM = 24;
  function made(name2, text, parent, style = "") {
    const element = document.createElement(name2);
    element.textContent = text;
    if (style) element.className = style;
    parent.append(element);
    return element;
  }
  function svg(name2, attributes, parent, text = "") {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name2);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
    if (text) element.textContent = text;
    parent.append(element);
    return element;
  }
  function say(parent, answer2) {
    parent.replaceChildren();
    parent.className = `verdict ${answer2.failed ? "bad" : answer2.level ?? ""}`;
    made("h2", answer2.failed ? "No answer" : answer2.headline ?? "", parent);
    for (const sentence of answer2.failed ? [answer2.failed] : answer2.sentences ?? []) made("p", sentence, parent);
    if (answer2.cautions?.length) {
      const list2 = made("ul", "", parent);
      for (const caution of answer2.cautions) made("li", caution, list2);
      if (answer2.more_cautions) made("li", `and ${answer2.more_cautions} more`, list2);
    }
  }
  function list(parent, problems, more, go) {
    parent.replaceChildren();
    for (const one of problems) {
      const line = made("button", `${one.line ? `line ${one.line}: ` : ""}${one.where ? `${one.where}: ` : ""}${one.what}`, parent);
      line.setAttribute("type", "button");
      line.addEventListener("click", () => go(one.line));
      const details = [one.came && `given: ${one.came}`, one.allowed && `allowed: ${one.allowed}`, one.todo];
      made("small", details.filter(Boolean).join("; "), line);
    }
    if (more) made("p", `and ${more} more`, parent, "note");
  }
  var Curves = class {
    constructor(parent, note) {
      this.parent = parent;
      this.note = note;
      document.addEventListener("crumple-time", (event) => {
        this.time = event.detail;
      });
    }
    parent;
    note;
    now = [];
    before = [];
    end = 0;
    time = Infinity;
    show(answer2, before2) {
      this.now = answer2.curves?.all ?? [];
      this.end = answer2.curves?.end ?? 0;
      this.before = before2;
      this.band(null);
    }
    /** Draw the curves with the bands that the laws give them, or without. */
    band(bands) {
      const same = (one, curve) => one.name === curve.name && one.unit === curve.unit;
      this.parent.replaceChildren();
      for (const curve of this.now) {
        this.chart(curve, this.before.find((one) => same(one, curve)), bands?.curves.find((one) => same(one, curve)), this.end);
      }
      const others = bands?.without ? `; the other ${bands.without === 1 ? "one has" : `${bands.without} have`} no known band` : "";
      const failed = bands?.failed ? `; ${bands.failed} of the runs did not reach their end` : "";
      this.note.textContent = bands?.curves.length ? `Shaded: range of runs with ${bands.laws} of the hinge laws at the edges of their bands${others}${failed}.` : "";
    }
    get shown() {
      return this.now;
    }
    chart(curve, before2, band, end) {
      const picture = svg("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, class: "chart", role: "img", "aria-label": curve.name }, this.parent);
      const values = curve.values[0] ?? [], earlier = before2?.values[0] ?? [];
      const reach = [0, ...values, ...earlier, ...band ? [...band.low, ...band.high] : []];
      const low = Math.min(...reach), high = Math.max(...reach), span = high - low || 1;
      const x = (i) => LEFT + (WIDE - LEFT - RIGHT) * i / Math.max(values.length - 1, 1);
      const y = (v) => TALL - BOTTOM - (TALL - TOP - BOTTOM) * (v - low) / span;
      const line = (list2) => list2.map((v, i) => `${x(i).toFixed(1)},${y(v).toFixed(1)}`).join(" ");
      svg("text", { x: 0, y: 13, class: "name" }, picture, `${curve.name}, ${curve.unit}`);
      for (const v of /* @__PURE__ */ new Set([low, 0, high])) {
        svg("line", { x1: LEFT, x2: WIDE - RIGHT, y1: y(v), y2: y(v), class: "axis" }, picture);
        svg("text", { x: LEFT - 5, y: y(v) + 4, "text-anchor": "end" }, picture, String(Number(v.toPrecision(3))));
      }
      const [factor, unit] = end > 2 ? [1, "s"] : [1e3, "ms"];
      svg("text", { x: WIDE - RIGHT, y: TALL - 8, "text-anchor": "end" }, picture, `${Number((factor * end).toPrecision(4))} ${unit}`);
      if (band) {
        const back = band.low.map((v, i) => `${x(i).toFixed(1)},${y(v).toFixed(1)}`).reverse().join(" ");
        svg("polygon", { points: `${line(band.high)} ${back}`, class: "band" }, picture);
      }
      if (earlier.length) svg("polyline", { points: line(earlier), class: "middle" }, picture);
      svg("polyline", { points: line(values), class: "now" }, picture);
      const cursor = svg("line", { y1: TOP, y2: TALL - BOTTOM, class: "cursor" }, picture);
      const put = (time) => {
        const at = LEFT + (WIDE - LEFT - RIGHT) * Math.min(time / (end || 1), 1);
        for (const side of ["x1", "x2"]) cursor.setAttribute(side, String(at));
      };
      put(Math.min(this.time, end));
      const follow2 = (event) => {
        if (picture.isConnected) put(event.detail);
        else document.removeEventListener("crumple-time", follow2);
      };
      document.addEventListener("crumple-time", follow2);
    }
  };
  var Pictures = class {
    addresses = [];
    used = [];
    begin() {
      this.used = this.addresses;
      this.addresses = [];
    }
    end() {
      for (const address of this.used) URL.revokeObjectURL(address);
    }
    image(svg2, alt) {
      const address = URL.createObjectURL(new Blob([svg2], { type: "image/svg+xml" }));
      this.addresses.push(address);
      const image = Object.assign(document.createElement("img"), { src: address, alt });
      image.dataset.points = /viewBox="0 0 ([\d.]+)/.exec(svg2)?.[1] ?? "0";
      return image;
    }
  };
  var Figures = class {
    constructor(parent) {
      this.parent = parent;
    }
    parent;
    pictures = new Pictures();
    show(figures2) {
      this.pictures.begin();
      this.parent.replaceChildren();
      for (const figure of figures2) {
        const place = made("figure", "", this.parent), panels = made("div", "", place, "panels");
        for (const panel of figure.panels) {
          const picture = this.pictures.image(panel.svg, panel.name.replaceAll("_", " "));
          const holder = made("div", "", panels, Number(picture.dataset.points) > FULL ? "panel full" : "panel");
          const link = document.createElement("a");
          Object.assign(link, { href: picture.src, download: `${panel.name}.svg`, textContent: "SVG", className: "note" });
          holder.append(picture, link);
        }
        made("figcaption", figure.caption, place);
      }
      this.pictures.end();
    }
  };

  // forms.ts
  var KINDS = ["sections", "hinge_laws"];
  var HEADS = { sections: "Section", hinge_laws: "Law" };
  var NUMBER = /^[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?$/;
  function owner(path) {
    const [kind = "", name2 = ""] = path.split(/[.[]/);
    return KINDS.includes(kind) && name2 ? `${kind}.${name2}` : "";
  }
  var Forms = class {
    /** @param begun called before the first change of a field */
    constructor(parent, editor2, schema, begun) {
      this.parent = parent;
      this.editor = editor2;
      this.schema = schema;
      this.begun = begun;
    }
    parent;
    editor;
    schema;
    begun;
    scalars = /* @__PURE__ */ new Map();
    fields = /* @__PURE__ */ new Map();
    shown = /* @__PURE__ */ new Map();
    layout = "";
    pictures = new Pictures();
    /** Scalars of the text as it is now. */
    set(numerals, words) {
      const all = [...words, ...numerals].filter((one) => owner(one.path)).sort((a, b) => a.start - b.start);
      this.scalars = new Map(all.map((one) => [one.path, { ...one }]));
      const layout = all.map((one) => `${one.path} ${"unit" in one ? one.unit : this.options(one).join()}`).join("\n");
      if (layout !== this.layout) this.build(all);
      this.layout = layout;
      const text = this.editor.text;
      for (const [path, field] of this.fields) {
        const one = this.scalars.get(path);
        if (one && field !== document.activeElement) field.value = text.slice(one.start, one.end);
      }
    }
    /** The text changed: places move with it, and fields of scalars that were replaced do nothing until the answer comes. */
    moved(changes) {
      for (const [path, one] of this.scalars) if (!follow(one, changes)) this.scalars.delete(path);
    }
    /** Drawings, capacities and curves. */
    show(forms2) {
      this.pictures.begin();
      for (const place of this.shown.values()) place.replaceChildren();
      for (const form of forms2) {
        const place = this.shown.get(form.path);
        if (!place) continue;
        if (form.title) made("p", form.title, place, "note");
        if (form.drawing) made("div", "", place, "drawing").append(this.pictures.image(form.drawing, `${form.path}: drawing and capacities`));
        if (form.rows.length) {
          const table = made("dl", "", place, "values");
          for (const [name2, value] of form.rows) {
            const pair = made("div", "", table);
            made("dt", name2, pair);
            made("dd", value, pair);
          }
        }
        for (const curve of form.curves) {
          const figure = made("figure", "", place);
          figure.append(this.pictures.image(curve.svg, `${form.path}: law`));
          made("figcaption", curve.caption, figure);
        }
      }
      this.pictures.end();
    }
    options(word) {
      const root = this.schema();
      if (!root) return [];
      const texts = below(root, word.path.split(".")).flatMap((one) => [...one.enum ?? [], ...one.const === void 0 ? [] : [one.const]]);
      return [...new Set(texts.map(String))];
    }
    build(all) {
      const open = new Set([...this.parent.querySelectorAll("details[open]")].map((one) => one.dataset.path));
      this.fields.clear();
      this.shown.clear();
      this.parent.replaceChildren();
      for (const path of new Set(all.map((one) => owner(one.path)))) {
        const [kind = "", name2 = ""] = path.split(".");
        const group = document.createElement("details"), fields = document.createElement("div");
        group.dataset.path = path;
        group.open = open.has(path);
        made("summary", `${HEADS[kind] ?? kind} ${name2}`, group);
        fields.className = "fields";
        for (const one of all) if (owner(one.path) === path) this.row(one, one.path.slice(path.length + 1), fields);
        group.append(fields);
        this.shown.set(path, made("div", "", group));
        this.parent.append(group);
      }
    }
    row(one, name2, parent) {
      const label = made("label", "", parent), number = "unit" in one, choices = number ? [] : this.options(one);
      made("span", name2.replaceAll("_", " "), label);
      if (!number && (name2 === "type" || choices.length < 2)) {
        made("output", one.text, label);
        return;
      }
      const field = document.createElement(number ? "input" : "select");
      if (field instanceof HTMLSelectElement) field.append(...choices.map((text) => new Option(text, text)));
      else Object.assign(field, { type: "text", inputMode: "decimal", autocomplete: "off", spellcheck: false });
      field.setAttribute("aria-label", one.path);
      field.dataset.path = one.path;
      label.append(field);
      if (number && one.unit) made("output", one.unit, label);
      this.fields.set(one.path, field);
      let first2 = true;
      field.addEventListener("input", () => {
        const text = field.value.trim(), wrong = number && !NUMBER.test(text);
        field.setAttribute("aria-invalid", String(wrong));
        const now = this.scalars.get(one.path);
        if (wrong || !now) return;
        if (first2) this.begun();
        this.editor.put(now.start, now.end, text, first2);
        first2 = false;
      });
      field.addEventListener("blur", () => {
        first2 = true;
        const now = this.scalars.get(one.path);
        if (now) field.value = this.editor.text.slice(now.start, now.end);
        field.setAttribute("aria-invalid", "false");
      });
    }
  };

  // socket.ts
  var AGAIN = 1500;
  var TOO_MANY = 4001;
  var NOT_ALLOWED = 4003;
  var Connection = class {
    /** @param received takes messages @param told says how the connection is, empty if well */
    constructor(received, told2) {
      this.received = received;
      this.told = told2;
    }
    received;
    told;
    token = "";
    socket = null;
    async begin() {
      const code = location.hash.slice(1);
      history.replaceState(null, "", location.pathname);
      if (!code) {
        this.told("This page was opened without its code. Start it again: crumple app");
        return;
      }
      const answer2 = await fetch("/token", { method: "POST", body: code });
      if (!answer2.ok) {
        this.told("This address was used already. Start again: crumple app");
        return;
      }
      this.token = (await answer2.json()).token;
      this.connect();
    }
    connect() {
      const socket = new WebSocket(`ws://${location.host}/window`);
      this.socket = socket;
      socket.onopen = () => {
        socket.send(JSON.stringify({ token: this.token }));
        this.told("");
      };
      socket.onmessage = (event) => this.received(JSON.parse(event.data));
      socket.onclose = (event) => {
        this.socket = null;
        if (event.code === TOO_MANY) this.told("Too many windows are open: close one, then load this page anew.");
        else if (event.code === NOT_ALLOWED) this.told("The server was started anew. Start again: crumple app");
        else {
          this.told("The connection ended. Your text is kept here; trying again …");
          setTimeout(() => this.connect(), AGAIN);
        }
      };
    }
    /** Whether the message was sent. */
    send(message) {
      if (this.socket?.readyState !== WebSocket.OPEN) return false;
      this.socket.send(JSON.stringify(message));
      return true;
    }
  };

  // sliders.ts
  var MOST = 40;
  var STEPS = 200;
  function written(value) {
    const text = Number(value.toPrecision(4)).toString();
    return text.includes("e") ? value.toPrecision(4).replace(/\.?0+e/, "e") : text;
  }
  function range(value) {
    if (value === 0) return [-1, 1];
    return value > 0 ? [0.5 * value, 1.5 * value] : [1.5 * value, 0.5 * value];
  }
  var Sliders = class {
    constructor(list2, filter, editor2, begun, ended) {
      this.list = list2;
      this.filter = filter;
      this.editor = editor2;
      this.begun = begun;
      this.ended = ended;
      filter.addEventListener("input", () => this.draw());
    }
    list;
    filter;
    editor;
    begun;
    ended;
    numerals = [];
    dragged = "";
    get dragging() {
      return this.dragged !== "";
    }
    /** Numbers of the text as it is now. */
    set(numerals) {
      if (this.dragging) return;
      this.numerals = numerals;
      this.draw();
    }
    /** The text changed: places move with it, and numbers that were replaced have no slider until the answer comes. */
    moved(changes) {
      this.numerals = this.numerals.filter((one) => follow(one, changes));
    }
    /** The number at the cursor comes first. */
    draw() {
      if (this.dragging) return;
      const wanted = this.filter.value.trim().toLowerCase(), cursor = this.editor.cursor;
      const line = this.editor.view.state.doc.lineAt(cursor);
      const here = (one) => Number(one.start >= line.from && one.end <= line.to) + Number(one.start <= cursor && cursor <= one.end);
      const shown2 = this.numerals.filter((one) => one.path.toLowerCase().includes(wanted));
      shown2.sort((a, b) => here(b) - here(a));
      this.list.replaceChildren(...shown2.slice(0, MOST).map((one) => this.row(one)));
      if (shown2.length > MOST) {
        const rest = document.createElement("p");
        rest.className = "note";
        rest.textContent = `${shown2.length - MOST} more: type a part of the name above.`;
        this.list.append(rest);
      }
    }
    row(one) {
      const label = document.createElement("label"), name2 = document.createElement("span");
      const input = document.createElement("input"), output = document.createElement("output");
      const [low, high] = range(one.value);
      name2.textContent = one.path;
      output.textContent = `${written(one.value)} ${one.unit}`;
      Object.assign(input, { type: "range", min: low, max: high, step: (high - low) / STEPS, value: one.value });
      input.setAttribute("aria-label", one.path);
      input.dataset.path = one.path;
      const ended = () => {
        if (!this.dragging) return;
        this.dragged = "";
        this.ended();
      };
      input.addEventListener("input", () => {
        if (!this.numerals.includes(one)) return;
        const first2 = this.dragged !== one.path;
        if (first2) this.begun();
        this.dragged = one.path;
        const text = written(Number(input.value));
        this.editor.put(one.start, one.end, text, first2);
        output.textContent = `${text} ${one.unit}`;
        input.setAttribute("aria-valuetext", output.textContent);
      });
      input.addEventListener("change", ended);
      input.addEventListener("blur", ended);
      label.append(name2, input, output);
      return label;
    }
  };

  // app.ts
  var TYPED = 150;
  var DRAFT = 1e3;
  var BURST = 2e3;
  var find = (id) => document.getElementById(id);
  var [files, starts, name, save, title, banner, refusal] = [
    find("files"),
    find("starts"),
    find("name"),
    find("save"),
    find("file-state"),
    find("banner"),
    find("refusal")
  ];
  var [check, cancel, bar, beside, draft] = [
    find("check"),
    find("cancel"),
    find("share"),
    find("beside"),
    find("draft")
  ];
  var curves = new Curves(find("curves"), find("band"));
  var figures = new Figures(find("figures"));
  var seen = "";
  var saved = "";
  var first = "";
  var asked = 0;
  var answered = 0;
  var waiting = false;
  var wantsNumbers = true;
  var shown = null;
  var before;
  var curvesBefore = [];
  var changed = -Infinity;
  var typing = 0;
  var keeping = 0;
  var keptDraft = null;
  var drafted = false;
  var besideNames = [];
  var told = [];
  var nonce = document.querySelector("meta[name=style-nonce]")?.content ?? "";
  var connection = new Connection(receive, (what) => {
    banner.textContent = what;
    banner.hidden = !what;
  });
  var editor = new Editor(find("editor"), nonce, {
    changed(changes, whole) {
      sliders.moved(changes);
      forms.moved(changes);
      const now = performance.now();
      if (!sliders.dragging && now - changed > BURST) remember();
      if (whole) {
        before = void 0;
        curvesBefore = [];
      }
      changed = now;
      state();
      clearTimeout(typing);
      typing = 0;
      if (sliders.dragging || whole) ask(!sliders.dragging);
      else typing = window.setTimeout(() => {
        typing = 0;
        ask(true);
      }, TYPED);
      clearTimeout(keeping);
      keeping = window.setTimeout(keep, DRAFT);
    },
    moved() {
      sliders.draw();
    },
    save: store
  });
  var sliders = new Sliders(find("sliders"), find("filter"), editor, remember, () => ask(true));
  var forms = new Forms(find("forms"), editor, () => editor.schema, remember);
  function remember() {
    before = shown ?? void 0;
    curvesBefore = curves.shown;
  }
  function state() {
    const dirty = editor.text !== saved;
    title.textContent = dirty ? "not saved" : seen ? "saved" : "";
    document.title = `${dirty ? "• " : ""}${name.value || "new input"} · Crumple`;
  }
  var questioned = 0;
  function ask(numbers) {
    wantsNumbers ||= numbers;
    if (waiting) {
      asked++;
      return;
    }
    const besides = besideNames.length > 0;
    const sent = connection.send({
      kind: besides ? "beside" : "solve",
      number: ++asked,
      name: name.value,
      text: editor.text,
      numbers: wantsNumbers,
      quick: sliders.dragging,
      names: besideNames
    });
    waiting = sent;
    questioned = performance.now();
    if (sent) {
      answered = asked;
      wantsNumbers = false;
    }
  }
  function keep() {
    const dirty = editor.text !== saved;
    if (dirty) connection.send({ kind: "draft", name: name.value, text: editor.text });
    else if (drafted) connection.send({ kind: "discard", name: name.value });
    drafted = dirty;
  }
  function store() {
    refusal.hidden = true;
    if (!name.value) {
      name.focus();
      refuse("give the file a name that ends with .yaml");
      return;
    }
    connection.send({ kind: "save", name: name.value, text: editor.text, seen: name.value === first ? seen : "" });
  }
  function refuse(what) {
    refusal.textContent = what;
    refusal.hidden = false;
  }
  var drawing = 0;
  var last = Promise.resolve();
  function draw(answer2, live) {
    drawing++;
    last = last.catch(() => void 0).then(() => drawNow(answer2, live)).finally(() => {
      drawing--;
    });
    return last;
  }
  async function drawNow(answer2, live) {
    if (!answer2.scene) return;
    const old = live ? before : void 0;
    const header = JSON.parse(answer2.scene.header), names = header.models.map((model) => model.name);
    shown = await window.crumplePlayer.show(header, answer2.scene.payload, old);
    find("models").replaceChildren(...(names.length > 1 ? names : []).map((text) => Object.assign(document.createElement("span"), { textContent: text })));
    find("nothing").hidden = true;
  }
  async function answer(message) {
    waiting = false;
    if (asked !== answered) ask(false);
    const problems = message.problems ?? [];
    list(find("problems"), problems, message.more ?? 0, (line) => editor.go(line));
    editor.show(problems);
    if (message.numbers) {
      if (asked === message.number) {
        sliders.set(message.numbers);
        forms.set(message.numbers, message.words ?? []);
      } else wantsNumbers = true;
    }
    document.body.classList.toggle("stale", problems.length > 0 || !!message.failed);
    if (problems.length || message.stopped) return;
    say(find("said"), message);
    curves.show(message, curvesBefore);
    await draw(message, true);
    told.push(performance.now() - questioned);
  }
  function receive(message) {
    switch (message.kind) {
      case "welcome":
        find("folder").textContent = message.folder;
        fill(files, message.files, "Open …");
        fill(beside, message.files, "Beside …");
        fill(starts, message.starts.map((one) => [one.name, one.title]), "New from …");
        editor.schema = message.schema;
        waiting = false;
        if (editor.text) ask(true);
        else if (message.first) connection.send({ kind: "open", name: message.first });
        else connection.send({ kind: "start", name: message.starts.find((one) => one.name === "tube_bending")?.name ?? "" });
        break;
      case "opened":
        refusal.hidden = true;
        [seen, saved, first, name.value] = [message.seen, message.seen ? message.text : "", message.name, message.name];
        besideNames = [];
        keptDraft = message.draft !== null && message.draft !== message.text ? message.draft : null;
        draft.hidden = keptDraft === null;
        drafted = false;
        editor.replace(message.text);
        state();
        break;
      case "answer":
        void answer(message);
        break;
      case "figures":
        if (message.number === asked) figures.show(message.figures ?? []);
        break;
      case "forms":
        if (message.number === asked) forms.show(message.forms ?? []);
        break;
      case "bands":
        if (message.number === asked) curves.band(message.bands ?? null);
        break;
      case "saved":
        [seen, saved, first] = [message.seen, editor.text, message.name];
        draft.hidden = true;
        fill(files, message.files, "Open …");
        fill(beside, message.files, "Beside …");
        state();
        break;
      case "progress":
        bar.value = message.share;
        break;
      case "shell":
        checked(message);
        break;
      case "code":
        find("window").href = `/#${message.code}`;
        find("window").hidden = false;
        break;
      case "refused":
        if (message.of === "solve" || message.of === "beside") waiting = false;
        if (message.of === "shell") running(false);
        refuse(message.what);
        break;
      default:
        break;
    }
  }
  function checked(message) {
    running(false);
    const problems = message.problems ?? [];
    if (message.stopped) {
      refuse("the shell check was cancelled");
      return;
    }
    if (problems.length) {
      list(find("problems"), problems, message.more ?? 0, (line) => editor.go(line));
      return;
    }
    say(find("checked"), message);
    find("checked").hidden = false;
    void draw(message, false);
  }
  function running(now) {
    check.disabled = now;
    bar.hidden = cancel.hidden = !now;
    bar.value = 0;
  }
  function fill(select, entries, head) {
    select.replaceChildren(new Option(head, ""), ...entries.map((one) => typeof one === "string" ? new Option(one, one) : new Option(one[1], one[0])));
  }
  function chosen(select, kind) {
    select.addEventListener("change", () => {
      if (!select.value) return;
      keep();
      connection.send({ kind, name: select.value });
      select.value = "";
    });
  }
  chosen(files, "open");
  chosen(starts, "start");
  save.addEventListener("click", store);
  name.addEventListener("input", state);
  check.addEventListener("click", () => {
    refusal.hidden = true;
    if (connection.send({ kind: "shell", name: name.value, text: editor.text })) running(true);
  });
  cancel.addEventListener("click", () => connection.send({ kind: "cancel" }));
  beside.addEventListener("change", () => {
    besideNames = beside.value ? [.../* @__PURE__ */ new Set([...besideNames, beside.value])].slice(-3) : [];
    beside.value = "";
    find("alone").hidden = !besideNames.length;
    ask(false);
  });
  find("alone").addEventListener("click", () => {
    besideNames = [];
    find("alone").hidden = true;
    ask(false);
  });
  find("new-window").addEventListener("click", () => connection.send({ kind: "code" }));
  find("window").addEventListener("click", () => {
    find("window").hidden = true;
  });
  find("restore").addEventListener("click", () => {
    if (keptDraft !== null) editor.replace(keptDraft);
    draft.hidden = true;
  });
  find("discard").addEventListener("click", () => {
    connection.send({ kind: "discard", name: name.value });
    draft.hidden = true;
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "s" || !(event.ctrlKey || event.metaKey) || event.defaultPrevented) return;
    event.preventDefault();
    store();
  });
  window.addEventListener("pagehide", keep);
  window.crumpleApp = { editor, told, get idle() {
    return !typing && !waiting && asked === answered && !drawing;
  } };
  void connection.begin().catch(() => {
    banner.textContent = "The server does not answer. Start it again: crumple app";
    banner.hidden = false;
  });
})();
