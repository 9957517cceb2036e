"use strict";
/* Turns the cam by the slider: drawing, values, a cursor in each figure over the turn. Filters. */
(function () {
  const form = document.getElementById("turning"), slider = document.getElementById("angle");
  const turn = JSON.parse(document.getElementById("turn-data").textContent);
  const words = document.getElementById("angle-words");
  const drawing = document.querySelector(".mechanism svg");
  const heading = document.querySelector("#arrangement h3");

  const parts = Object.entries(turn.poses).map(([name, poses]) => {
    const group = drawing.querySelector(`[data-part="${name}"]`);
    const stretches = poses.some((pose) => pose[3] !== poses[0][3]);
    const lines = stretches ? [...group.children].map((line) => [line, line.getAttribute("d")]) : [];
    return { group, poses, lines };
  });
  const arrows = Object.entries(turn.arrows).map(([name, ends]) => {
    const line = drawing.querySelector(`[data-arrow="${name}"]`);
    return { line, ends, head: 3.4 * parseFloat(line.getAttribute("stroke-width")) };
  });
  const values = Object.entries(turn.words).map(([name, texts]) =>
    [drawing.querySelector(`[data-value="${name}"]`), texts]);

  function place(part, at) {
    const [angle, x, y, stretch] = part.poses[at];
    part.group.setAttribute("transform", `translate(${x} ${-y}) rotate(${-angle})`);
    const ratio = stretch / part.poses[turn.at][3];
    for (const [line, path] of part.lines) /* lengths along y alone: the wire keeps its width */
      line.setAttribute("d", path.replace(/([ML]\S+ )(\S+?)(?=[MLZ]|$)/g,
        (_, before, y0) => before + (ratio * parseFloat(y0)).toFixed(3)));
  }

  function point(arrow, at) {
    const [x1, y1, x2, y2] = arrow.ends[at], length = Math.hypot(x2 - x1, y2 - y1);
    const share = 1 - arrow.head / length;
    arrow.line.setAttribute("visibility", share > 0 ? "visible" : "hidden");
    if (!(share > 0)) return;
    arrow.line.setAttribute("x1", x1);
    arrow.line.setAttribute("y1", -y1);
    arrow.line.setAttribute("x2", x1 + share * (x2 - x1));
    arrow.line.setAttribute("y2", -(y1 + share * (y2 - y1)));
  }

  function set(at) {
    for (const part of parts) place(part, at);
    for (const arrow of arrows) point(arrow, at);
    for (const [text, texts] of values) text.textContent = texts[at];
    const shown = `${turn.words.angle[at]}, lift ${turn.lift[at]}`;
    words.textContent = shown;
    slider.setAttribute("aria-valuetext", shown);
    heading.textContent = at === turn.at ? "Arrangement at the worst angle" : "Arrangement";
    document.dispatchEvent(new CustomEvent("cam-angle", { detail: turn.shaft[at] }));
  }

  slider.max = turn.shaft.length - 1;
  slider.value = turn.at;
  form.hidden = false;
  form.addEventListener("submit", (event) => event.preventDefault());
  slider.addEventListener("input", () => set(Number(slider.value)));
  set(turn.at);

  for (const filters of document.querySelectorAll(".filters")) {
    const rows = [...document.querySelectorAll(`#${filters.dataset.table} tbody tr`)];
    const count = filters.querySelector("output");
    filters.hidden = false;
    filters.addEventListener("submit", (event) => event.preventDefault());
    filters.addEventListener("input", () => {
      const status = filters.elements.status.value, part = filters.elements.part.value;
      for (const row of rows)
        row.hidden = Boolean((status && row.dataset.status !== status) ||
          (part && row.dataset.part !== part));
      count.textContent = `${rows.filter((row) => !row.hidden).length} checks`;
    });
  }
})();
