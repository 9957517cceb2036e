"use strict";
/* Parallel coordinates, scatter matrix and front of a study; a range on one selects on all. */
(function () {
  const source = JSON.parse(document.getElementById("study-data").textContent);
  const decoded = (text, Kind) => new Kind(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const columns = source.columns.map((column) => ({ ...column, values: decoded(column.values, Float32Array) }));
  const state = decoded(source.state, Uint8Array), design = decoded(source.design, Uint32Array);
  const governing = decoded(source.governing, Uint16Array);
  const count = design.length, LINES = 1500, ROWS = 15, STATES = ["blue", "vermillion", "muted"];
  const ranges = new Map(), selected = new Uint8Array(count).fill(1);
  const byId = (id) => document.getElementById(id);
  const shownOn = { axes: columns.map((c) => c.axes), matrix: columns.map((c) => c.matrix) };
  /* a fixed order in which any beginning is spread over the designs */
  const order = Uint32Array.from({ length: count }, (_, k) => k)
    .sort((a, b) => ((a * 2654435761) >>> 0) - ((b * 2654435761) >>> 0));
  let palette = {}, waiting = false, chosen = count;

  const number = (value) => {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size && (size < 1e-3 || size >= 1e6)) return value.toExponential(2).replace("-", "−");
    return String(Number(value.toPrecision(4))).replace("-", "−");
  };
  const within = (column, ends) => ends.map((value) => Math.min(Math.max(value, column.low), column.high));
  const shown = (column, value) => (column.labels ? column.labels[Math.round(value)] || "–" : number(value));
  const unit = (column) => (column.unit ? ", " + column.unit : "");
  const thousands = (value) => value.toLocaleString("en-US");

  /* ends of an axis: without outliers far beyond the middle 98 %, which are drawn at the edge */
  for (const column of columns) {
    const known = column.values.filter(Number.isFinite).sort(), last = known.length - 1;
    let low = 0, high = 1;
    if (column.labels) [low, high] = [-0.5, column.labels.length - 0.5];
    else if (last >= 0) {
      [low, high] = [known[0], known[last]];
      const ends = [0.01, 0.99].map((share) => known[Math.round(share * last)]), room = 0.5 * (ends[1] - ends[0]);
      if (room > 0) [low, high] = [Math.max(low, ends[0] - room), Math.min(high, ends[1] + room)];
      if (column.limit !== null && low < column.limit) high = Math.min(high, 3 * column.limit);
      const more = high > low ? 0.02 * (high - low) : 0.5 * (Math.abs(low) || 1);
      [low, high] = [low - more, high + more];
    }
    column.edge = { low: known[0] < low, high: known[last] > high };
    column.drawn = column.values.map((value) => Math.min(Math.max(value, low), high));
    Object.assign(column, { low, high });
  }

  function ticks(column, most) {
    if (column.labels) return column.labels.map((_, k) => k).filter((k) => column.labels.length <= most || k % Math.ceil(column.labels.length / most) === 0);
    const rough = (column.high - column.low) / most, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= rough);
    const made = [];
    for (let k = Math.ceil(column.low / step); k * step <= column.high; k++) made.push(k * step);
    return made;
  }

  const beyond = (column) => [["high", "≥ "], ["low", "≤ "]]
    .filter(([end]) => column.edge[end]).map(([end, sign]) => [column[end], sign]);

  /* ---- selection ---- */
  function select() {
    selected.fill(1);
    for (const [index, [low, high]] of ranges) {
      const values = columns[index].values;
      for (let k = 0; k < count; k++) if (!(values[k] >= low && values[k] <= high)) selected[k] = 0;
    }
    chosen = selected.reduce((sum, one) => sum + one, 0);
    later();
  }

  function range(index, ends) {
    if (!ends) return void ranges.delete(index);
    const { low, high } = columns[index], [from, to] = [Math.min(...ends), Math.max(...ends)];
    ranges.set(index, [from <= low ? -Infinity : from, to >= high ? Infinity : to]);
  }

  function later() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(); });
  }

  /* ---- canvas ---- */
  const widthOf = (place) => {
    const { paddingLeft, paddingRight } = getComputedStyle(place);
    return Math.max(Math.floor(place.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight)), Number(place.dataset.least));
  };

  function canvasOf(place, height) {
    const canvas = place.querySelector("canvas"), width = widthOf(place);
    const sharp = Math.min(window.devicePixelRatio || 1, 2);
    if (canvas.width !== Math.round(width * sharp) || canvas.height !== Math.round(height * sharp)) {
      canvas.width = Math.round(width * sharp);
      canvas.height = Math.round(height * sharp);
      Object.assign(canvas.style, { width: width + "px", height: height + "px" });
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(sharp, 0, 0, sharp, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    return { pen, width, height };
  }

  function cut(pen, text, width) {
    if (pen.measureText(text).width <= width) return text;
    let kept = text;
    while (kept.length > 1 && pen.measureText(kept + "…").width > width) kept = kept.slice(0, -1);
    return kept + "…";
  }

  /* a label on up to three lines above a point */
  function wrapped(pen, text, width) {
    const lines = [""];
    for (const word of text.split(/(?<=[ ._])/)) {
      const last = lines.length - 1;
      if (lines[last] && pen.measureText(lines[last] + word).width > width) lines.push(word);
      else lines[last] += word;
    }
    if (lines.length > 3) lines.splice(2, lines.length, lines.slice(2).join(""));
    return lines.map((line) => cut(pen, line.trim(), width));
  }

  /* ---- parallel coordinates ---- */
  const TOP = 62, BOTTOM = 22, HEIGHT = 400;
  let axes = [];
  function drawAxes() {
    const { pen, width, height } = canvasOf(byId("axes"), HEIGHT);
    const picked = columns.map((_, k) => k).filter((k) => shownOn.axes[k]);
    const side = 64, gap = picked.length > 1 ? (width - 2 * side) / (picked.length - 1) : 0;
    axes = picked.map((index, place) => ({ index, x: side + place * gap }));
    const y = (column, value) => height - BOTTOM - ((value - column.low) / (column.high - column.low)) * (height - TOP - BOTTOM);
    const line = (k) => {
      let on = false;
      for (const { index, x } of axes) {
        const value = columns[index].drawn[k];
        if (!Number.isFinite(value)) { on = false; continue; }
        if (on) pen.lineTo(x, y(columns[index], value));
        else pen.moveTo(x, y(columns[index], value));
        on = true;
      }
    };
    const lines = [[], [], [], []];  /* by state, and those not selected */
    let drawn = 0, back = 0;
    for (const k of order) {
      if (selected[k] && drawn < LINES) { lines[state[k]].push(k); drawn++; }
      else if (!selected[k] && back < LINES / 2) { lines[3].push(k); back++; }
    }
    pen.lineWidth = 1;
    for (const [group, colour, alpha] of [[3, "line", 0.35], [2, "muted", 0], [1, "vermillion", 0], [0, "blue", 0]]) {
      pen.globalAlpha = alpha || Math.min(0.85, Math.max(0.12, 60 / Math.max(drawn, 1) + 0.08));
      pen.strokeStyle = palette[colour];
      pen.beginPath();
      for (let k = 0; k < lines[group].length; k++) {
        line(lines[group][k]);
        if (k % 40 === 39) { pen.stroke(); pen.beginPath(); }
      }
      pen.stroke();
    }
    pen.globalAlpha = 1;
    for (const { index, x } of axes) {
      const column = columns[index];
      pen.strokeStyle = palette.ink;
      pen.beginPath(); pen.moveTo(x, TOP); pen.lineTo(x, height - BOTTOM); pen.stroke();
      pen.textAlign = "center"; pen.fillStyle = palette.ink; pen.font = "600 11px system-ui, sans-serif";
      const words = wrapped(pen, column.label + unit(column), Math.max(gap || 160, 60) - 8);
      words.forEach((text, k) => pen.fillText(text, x, TOP - 12 - 14 * (words.length - 1 - k)));
      pen.font = "10.5px system-ui, sans-serif"; pen.textAlign = "left";
      for (const [value, sign] of [...ticks(column, 6).map((v) => [v, ""]), ...beyond(column)]) {
        const at = y(column, value), text = cut(pen, sign + shown(column, value), Math.max(gap || 160, 44) - 10);
        pen.fillStyle = palette.card; pen.globalAlpha = 0.82;
        pen.fillRect(x + 4, at - 7, pen.measureText(text).width + 4, 13);
        pen.globalAlpha = 1; pen.fillStyle = palette.muted;
        pen.fillRect(x, at, 4, 1); pen.fillText(text, x + 6, at + 3.5);
      }
      if (column.limit !== null && column.limit >= column.low && column.limit <= column.high) {
        pen.strokeStyle = palette.fail; pen.lineWidth = 2.5;
        pen.beginPath(); pen.moveTo(x - 9, y(column, column.limit)); pen.lineTo(x + 9, y(column, column.limit)); pen.stroke();
        pen.lineWidth = 1;
      }
      if (ranges.has(index)) {
        const [low, high] = within(column, ranges.get(index)).map((value) => y(column, value));
        pen.fillStyle = palette.link; pen.globalAlpha = 0.22; pen.fillRect(x - 8, high, 16, low - high);
        pen.globalAlpha = 1; pen.strokeStyle = palette.link; pen.strokeRect(x - 8, high, 16, low - high);
      }
    }
    byId("thinned").textContent = drawn < chosen
      ? "Lines: " + thousands(drawn) + " of " + thousands(chosen) + " selected designs are drawn; points, counts and shares are of all designs in the page."
      : "";
  }

  (function brushAxes() {
    const canvas = byId("axes").querySelector("canvas");
    const value = (axis, y) => {
      const column = columns[axis.index], share = (HEIGHT - BOTTOM - y) / (HEIGHT - TOP - BOTTOM);
      return column.low + Math.min(Math.max(share, 0), 1) * (column.high - column.low);
    };
    let held = null;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "touch" || !axes.length) return;
      const nearest = axes.reduce((a, b) => (Math.abs(b.x - event.offsetX) < Math.abs(a.x - event.offsetX) ? b : a));
      if (Math.abs(nearest.x - event.offsetX) > 26) return;
      held = { axis: nearest, y: event.offsetY };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      canvas.style.cursor = axes.some(({ x }) => Math.abs(x - event.offsetX) <= 26) ? "ns-resize" : "default";
      if (!held || Math.abs(event.offsetY - held.y) < 3) return;
      range(held.axis.index, [value(held.axis, held.y), value(held.axis, event.offsetY)]);
      select();
    });
    canvas.addEventListener("pointerup", (event) => {
      if (held && Math.abs(event.offsetY - held.y) < 3) { range(held.axis.index, null); select(); }
      held = null;
    });
  })();

  /* ---- cells: two columns over each other, or the distribution of one ---- */
  function grid(pen, cell) {
    pen.strokeStyle = palette.grid; pen.lineWidth = 1;
    pen.strokeRect(cell.left + 0.5, cell.top + 0.5, cell.width - 1, cell.height - 1);
  }
  const across = (cell, value) => cell.left + ((value - cell.x.low) / (cell.x.high - cell.x.low)) * cell.width;
  const upward = (cell, value) => cell.top + cell.height - ((value - cell.y.low) / (cell.y.high - cell.y.low)) * cell.height;

  function drawPoints(pen, cell, size) {
    const xs = cell.x.drawn, ys = cell.y.drawn;
    const a = cell.width / (cell.x.high - cell.x.low), b = cell.height / (cell.y.high - cell.y.low);
    const bottom = cell.top + cell.height, half = size / 2;
    const put = (wanted, colour, alpha) => {
      pen.fillStyle = palette[colour]; pen.globalAlpha = alpha;
      for (let k = 0; k < count; k++) {
        if ((selected[k] ? state[k] : 3) !== wanted) continue;
        const x = cell.left + (xs[k] - cell.x.low) * a, y = bottom - (ys[k] - cell.y.low) * b;
        if (x === x && y === y) pen.fillRect(x - half, y - half, size, size);
      }
    };
    const alpha = Math.min(0.9, Math.max(0.3, 900 / Math.max(chosen, 1)));
    put(3, "line", 0.4); put(2, "muted", alpha); put(1, "vermillion", alpha); put(0, "blue", alpha);
    pen.globalAlpha = 1;
  }

  function drawRange(pen, cell) {
    const horizontal = ranges.get(cell.xIndex), vertical = cell.yIndex === null ? undefined : ranges.get(cell.yIndex);
    if (!horizontal && !vertical) return;
    const [left, right] = horizontal ? within(cell.x, horizontal).map((v) => across(cell, v)) : [cell.left, cell.left + cell.width];
    const [bottom, top] = vertical ? within(cell.y, vertical).map((v) => upward(cell, v)) : [cell.top + cell.height, cell.top];
    pen.fillStyle = palette.link; pen.globalAlpha = 0.1;
    pen.fillRect(left, top, right - left, bottom - top);
    pen.globalAlpha = 0.8; pen.strokeStyle = palette.link; pen.strokeRect(left, top, right - left, bottom - top);
    pen.globalAlpha = 1;
  }

  function drawBars(pen, cell) {
    const bins = Math.max(8, Math.min(30, Math.floor(cell.width / 6), cell.x.labels ? cell.x.labels.length : 30));
    const bars = [0, 1, 2, 3].map(() => new Uint32Array(bins));
    for (let k = 0; k < count; k++) {
      const at = Math.floor(((cell.x.drawn[k] - cell.x.low) / (cell.x.high - cell.x.low)) * bins);
      if (at >= 0) bars[selected[k] ? state[k] : 3][Math.min(at, bins - 1)]++;
    }
    let most = 1;
    for (let k = 0; k < bins; k++) most = Math.max(most, bars[0][k] + bars[1][k] + bars[2][k] + bars[3][k]);
    for (let k = 0; k < bins; k++) {
      let y = cell.top + cell.height;
      for (const [group, colour] of [[0, "blue"], [1, "vermillion"], [2, "muted"], [3, "line"]]) {
        const height = (bars[group][k] / most) * (cell.height - 36);
        pen.fillStyle = palette[colour];
        pen.fillRect(cell.left + (k * cell.width) / bins, y - height, cell.width / bins - 1, height);
        y -= height;
      }
    }
  }

  /* drag: a range of both columns; click: one design; pointing: its values */
  function brushCells(place, cells, redraw) {
    const canvas = place.querySelector("canvas"), tip = byId("tip");
    let held = null;
    const at = (event) => cells().find((c) => event.offsetX >= c.left && event.offsetX <= c.left + c.width && event.offsetY >= c.top && event.offsetY <= c.top + c.height);
    const xOf = (cell, x) => cell.x.low + Math.min(Math.max((x - cell.left) / cell.width, 0), 1) * (cell.x.high - cell.x.low);
    const yOf = (cell, y) => cell.y.low + Math.min(Math.max((cell.top + cell.height - y) / cell.height, 0), 1) * (cell.y.high - cell.y.low);
    function nearest(cell, event) {
      let best = -1, least = 81;
      for (let k = 0; cell.yIndex !== null && k < count; k++) {
        if (!selected[k]) continue;
        const gap = (across(cell, cell.x.drawn[k]) - event.offsetX) ** 2 + (upward(cell, cell.y.drawn[k]) - event.offsetY) ** 2;
        if (gap < least) [best, least] = [k, gap];
      }
      return best;
    }
    canvas.addEventListener("pointerdown", (event) => {
      const cell = event.pointerType !== "touch" && at(event);
      if (!cell) return;
      held = { cell, x: event.offsetX, y: event.offsetY };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      canvas.style.cursor = at(event) ? "crosshair" : "default";
      if (held && Math.hypot(event.offsetX - held.x, event.offsetY - held.y) >= 4) {
        tip.hidden = true;
        range(held.cell.xIndex, [xOf(held.cell, held.x), xOf(held.cell, event.offsetX)]);
        if (held.cell.yIndex !== null) range(held.cell.yIndex, [yOf(held.cell, held.y), yOf(held.cell, event.offsetY)]);
        select();
        return;
      }
      const cell = at(event), k = cell ? nearest(cell, event) : -1;
      tip.hidden = k < 0;
      if (k < 0) return;
      tip.textContent = "design " + design[k] + ", " + source.states[state[k]] + "\n" +
        [cell.x, cell.y].map((c) => c.label + " " + shown(c, c.values[k]) + (c.unit ? " " + c.unit : "")).join("\n");
      Object.assign(tip.style, { left: Math.min(event.clientX + 14, innerWidth - 250) + "px", top: event.clientY + 14 + "px" });
    });
    canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
    canvas.addEventListener("pointerup", (event) => {
      if (held && Math.hypot(event.offsetX - held.x, event.offsetY - held.y) < 4) {
        const k = nearest(held.cell, event);
        if (k >= 0) fillTable(k);
        else {
          range(held.cell.xIndex, null);
          if (held.cell.yIndex !== null) range(held.cell.yIndex, null);
          select();
        }
      }
      held = null;
    });
    return redraw;
  }

  /* ---- scatter matrix ---- */
  let matrix = [];
  const drawMatrix = brushCells(byId("matrix"), () => matrix, () => {
    const place = byId("matrix"), picked = columns.map((_, k) => k).filter((k) => shownOn.matrix[k]);
    const width = widthOf(place), left = 66, gap = 8;
    const size = picked.length ? (width - left - gap * (picked.length - 1) - 2) / picked.length : 0;
    const tall = Math.min(size, 190);
    const { pen } = canvasOf(place, Math.max(picked.length * (tall + gap) + 44, 60));
    matrix = [];
    picked.forEach((yIndex, row) => picked.forEach((xIndex, place_) => {
      if (place_ > row) return;
      const cell = { xIndex, yIndex: row === place_ ? null : yIndex, x: columns[xIndex], y: columns[yIndex],
        left: left + place_ * (size + gap), top: row * (tall + gap), width: size, height: tall };
      matrix.push(cell);
      grid(pen, cell);
      pen.save(); pen.beginPath(); pen.rect(cell.left, cell.top, size, tall); pen.clip();
      if (row === place_) drawBars(pen, cell);
      else drawPoints(pen, cell, count > 4000 ? 1.6 : 2.6);
      pen.restore();
      drawRange(pen, cell);
      pen.fillStyle = palette.muted; pen.font = "10px system-ui, sans-serif";
      if (place_ === 0 && row) {
        pen.textAlign = "right";
        for (const value of ticks(cell.y, 4)) pen.fillText(cut(pen, shown(cell.y, value), 44), left - 4, upward(cell, value) + 3);
      }
      if (row === picked.length - 1) {
        pen.textAlign = "center";
        for (const value of ticks(cell.x, 3)) pen.fillText(cut(pen, shown(cell.x, value), size / 3), across(cell, value), cell.top + tall + 13);
        pen.fillStyle = palette.ink; pen.font = "600 11px system-ui, sans-serif";
        pen.fillText(cut(pen, cell.x.label + unit(cell.x), size), cell.left + size / 2, cell.top + tall + 30);
      }
      if (row === place_) {
        pen.fillStyle = palette.ink; pen.font = "600 11px system-ui, sans-serif"; pen.textAlign = "left";
        const words = wrapped(pen, cell.x.label + unit(cell.x), size - 14);
        pen.globalAlpha = 0.85; pen.fillStyle = palette.card;
        words.forEach((text, k) => pen.fillRect(cell.left + 4, cell.top + 4 + 14 * k, pen.measureText(text).width + 6, 14));
        pen.globalAlpha = 1; pen.fillStyle = palette.ink;
        words.forEach((text, k) => pen.fillText(text, cell.left + 7, cell.top + 15 + 14 * k));
      }
    }));
    if (!picked.length) pen.fillText("Choose columns below.", left, 30);
  });

  /* ---- front ---- */
  let front = [];
  const drawFront = source.front ? brushCells(byId("front"), () => front, () => {
    const { pen, width, height } = canvasOf(byId("front"), 380);
    const { x, y, rows } = source.front;
    const cell = { xIndex: x, yIndex: y, x: columns[x], y: columns[y], left: 66, top: 10, width: width - 80, height: height - 60 };
    front = [cell];
    pen.strokeStyle = palette.grid; pen.fillStyle = palette.muted; pen.font = "10.5px system-ui, sans-serif";
    for (const value of ticks(cell.x, 8)) {
      pen.textAlign = "center"; pen.fillText(shown(cell.x, value), across(cell, value), cell.top + cell.height + 15);
      pen.beginPath(); pen.moveTo(across(cell, value), cell.top); pen.lineTo(across(cell, value), cell.top + cell.height); pen.stroke();
    }
    for (const value of ticks(cell.y, 6)) {
      pen.textAlign = "right"; pen.fillText(shown(cell.y, value), cell.left - 6, upward(cell, value) + 3.5);
      pen.beginPath(); pen.moveTo(cell.left, upward(cell, value)); pen.lineTo(cell.left + cell.width, upward(cell, value)); pen.stroke();
    }
    drawPoints(pen, cell, count > 4000 ? 2 : 3);
    drawRange(pen, cell);
    pen.strokeStyle = palette.ink; pen.lineWidth = 1.6; pen.beginPath();
    rows.forEach((k, place) => pen[place ? "lineTo" : "moveTo"](across(cell, cell.x.drawn[k]), upward(cell, cell.y.drawn[k])));
    pen.stroke();
    pen.lineWidth = 1.4;
    for (const k of rows) {
      pen.beginPath(); pen.arc(across(cell, cell.x.drawn[k]), upward(cell, cell.y.drawn[k]), 4.2, 0, 2 * Math.PI);
      pen.fillStyle = selected[k] ? palette[STATES[state[k]]] : palette.card; pen.fill(); pen.stroke();
    }
    pen.fillStyle = palette.ink; pen.textAlign = "center"; pen.font = "600 11px system-ui, sans-serif";
    pen.fillText(cell.x.label + unit(cell.x), cell.left + cell.width / 2, height - 12);
    pen.save(); pen.translate(13, cell.top + cell.height / 2); pen.rotate(-Math.PI / 2);
    pen.fillText(cell.y.label + unit(cell.y), 0, 0); pen.restore();
  }) : () => {};

  /* ---- counts, ranges, table ---- */
  const made = (kind, text, options) => Object.assign(document.createElement(kind), { textContent: text, ...options });

  const spanned = ([low, high]) => {
    if (low === -Infinity) return high === Infinity ? "any number" : "≤ " + number(high);
    return high === Infinity ? "≥ " + number(low) : number(low) + " to " + number(high);
  };

  function showCounts() {
    const counts = [0, 0, 0];
    for (let k = 0; k < count; k++) if (selected[k]) counts[state[k]]++;
    const judged = counts[0] + counts[1];
    byId("selected").textContent = thousands(chosen) + " of " + thousands(count) + " designs selected" +
      (judged ? "; " + source.states[0] + " " + ((100 * counts[0]) / judged).toFixed(1) + " %" : "");
    counts.forEach((value, k) => { byId("count-" + k).textContent = thousands(value); });
    const place = byId("ranges");
    place.replaceChildren(...[...ranges].map(([index, ends]) => {
      const column = columns[index];
      const words = column.labels
        ? column.labels.filter((_, k) => k >= ends[0] && k <= ends[1]).join(", ") || "none"
        : spanned(ends) + (column.unit ? " " + column.unit : "");
      const button = made("button", column.label + ": " + words + " ✕", { type: "button", className: "range" });
      button.setAttribute("aria-label", "Remove the range of " + column.label);
      button.addEventListener("click", () => { range(index, null); select(); });
      return button;
    }));
    byId("clear").hidden = !ranges.size;
  }

  function fillTable(single) {
    const sort = columns[Number(byId("sort").value)], sign = byId("descending").checked ? -1 : 1;
    const rank = (k) => (Number.isFinite(sort.values[k]) ? sign * sort.values[k] : Infinity);
    let rows = [];
    if (single !== undefined) rows = [single];
    else {
      for (let k = 0; k < count; k++) if (selected[k]) rows.push(k);
      rows.sort((a, b) => rank(a) - rank(b) || a - b);
      rows = rows.slice(0, ROWS);
    }
    const wanted = columns.map((_, k) => k).filter((k) => shownOn.axes[k]);
    const head = document.createElement("tr");
    for (const text of ["design", "state", "governing check", ...wanted.map((k) => columns[k].label + unit(columns[k])), "report"])
      head.append(Object.assign(made("th", text), { scope: "col" }));
    byId("rows").tHead.replaceChildren(head);
    byId("rows").tBodies[0].replaceChildren(...rows.map((k) => {
      const row = document.createElement("tr"), chip = made("span", source.states[state[k]], { className: "chip " + ["pass", "fail", "not_evaluated"][state[k]] });
      const cells = [made("td", design[k], { className: "n" }), document.createElement("td"), made("td", source.checks[governing[k]] || "–")];
      cells[1].append(chip);
      for (const index of wanted) cells.push(made("td", shown(columns[index], columns[index].values[k]), { className: columns[index].labels ? "" : "n" }));
      const link = source.links[design[k]], last = document.createElement("td");
      if (link) last.append(made("a", "open", { href: link }));
      else last.textContent = "–";
      row.append(...cells, last);
      return row;
    }));
    byId("listed").textContent = single === undefined ? "First " + rows.length + " of the selected designs." : "Design clicked; change the order to list the selection again.";
  }

  function draw() {
    drawAxes(); drawMatrix(); drawFront(); showCounts(); fillTable();
  }

  function theme() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["ink", "muted", "line", "grid", "card", "blue", "vermillion", "link", "fail"])
      palette[name] = style.getPropertyValue("--" + name).trim();
    later();
  }

  for (const [k, column] of columns.entries()) {
    for (const id of ["sort", "range-column"]) byId(id).append(made("option", column.label + unit(column), { value: k }));
    for (const view of ["axes", "matrix"]) {
      const label = document.createElement("label"), box = Object.assign(document.createElement("input"), { type: "checkbox", checked: shownOn[view][k] });
      box.addEventListener("change", () => { shownOn[view][k] = box.checked; later(); });
      label.append(box, " " + column.label + unit(column));
      byId("choose-" + view).append(label);
    }
  }
  byId("sort").value = String(source.sort);
  byId("sort").addEventListener("change", () => fillTable());
  byId("descending").addEventListener("change", () => fillTable());
  byId("clear").addEventListener("click", () => { ranges.clear(); select(); });
  byId("range-form").addEventListener("submit", (event) => {
    event.preventDefault();
    const index = Number(byId("range-column").value), { low, high } = columns[index];
    const end = (id, otherwise) => (byId(id).value === "" ? otherwise : Number(byId(id).value));
    range(index, [end("range-from", low), end("range-to", high)]);
    select();
  });
  byId("effect-of")?.addEventListener("change", (event) => {
    for (const one of document.querySelectorAll(".effect")) one.hidden = one.dataset.output !== event.target.value;
  });
  if (byId("effect-of")) byId("effect-of").dispatchEvent(new Event("change"));
  document.documentElement.classList.add("live-page");
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", theme);
  new ResizeObserver(later).observe(byId("axes"));
  theme();
})();
