"use strict";
/* Draws the scene by Plotly and sets it to the cam angle of the slider; angles in rad. */
(function () {
  const data = JSON.parse(document.getElementById("scene-data").textContent);
  const place = document.getElementById("scene"), slider = document.getElementById("turn");
  const readout = document.getElementById("readout"), play = document.getElementById("play");
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  const STEEL = "#c3cbd4", DARK = "#8b95a1", MARK = "#d55e00";
  const LIGHT = { ambient: 0.75, diffuse: 0.4, specular: 0.05, roughness: 0.8, fresnel: 0.02, facenormalsepsilon: 0 };
  const EVEN = { ambient: 0.92, diffuse: 0.1, specular: 0, roughness: 1, fresnel: 0 };
  const PLAIN = { ambient: 1, diffuse: 0, specular: 0, roughness: 1, fresnel: 0 };
  const EYES = { oblique: [1.15, 0.5, 0.95], front: [0, 0, 1.6], side: [1.55, 0.12, 0.35] };
  const camera = (name) => {
    const [x, y, z] = EYES[name];
    return { up: { x: 0, y: 1, z: 0 }, center: { x: 0, y: 0, z: 0 }, eye: { x, y, z } };
  };

  function webgl() {
    const canvas = document.createElement("canvas");
    return Boolean(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"));
  }

  const around = (xs, ys, angle) => {
    const c = Math.cos(angle), s = Math.sin(angle);
    return [xs.map((x, n) => c * x - s * ys[n]), xs.map((x, n) => s * x + c * ys[n])];
  };

  /* A line with gaps (null). */
  const turned = (line, angle) => around(line.x, line.y, angle)
    .map((part) => part.map((v, n) => (line.x[n] === null ? null : v)));

  function solid(body, more) {
    const { x, y, z, i, j, k } = body;
    return { type: "mesh3d", x, y, z, i, j, k, flatshading: true, lighting: LIGHT, color: STEEL,
      lightposition: { x: 400, y: 900, z: 1500 }, hoverinfo: "skip", ...more };
  }

  /* Edges of contour or bore on both end faces, as closed lines. */
  function edges(body, half) {
    const count = body.x.length / half, lines = { x: [], y: [], z: [], of: [] };
    for (let side = 0; side < half; side++) {
      for (let n = 0; n <= count; n++) {
        const at = side * count + (n % count);
        for (const name of "xyz") lines[name].push(body[name][at]);
        lines.of.push(body.values ? body.values[at] : 0);
      }
      for (const name of "xyz") lines[name].push(null);
      lines.of.push(0);
    }
    return lines;
  }

  /* Colour bar beside the bodies, in a narrow window below them, and the share left to them. */
  const narrow = matchMedia("(max-width: 640px)");
  const BAR_WIDTH = 150, BAR_HEIGHT = 84; // px
  const TITLES = { turn: ["maximum von Mises", "of the turn, MPa"], stress: ["von Mises stress,", "MPa"],
    pressure: ["contact pressure,", "MPa"] };
  let field = "turn";
  function arranged() {
    const below = narrow.matches, title = TITLES[field].join(below ? " " : "<br>");
    const bar = { title: { text: title, font: { size: 12 }, side: "top" }, thickness: 14,
      ...(below ? { orientation: "h", len: 0.9, x: 0.5, xanchor: "center", y: 0, yanchor: "bottom" }
        : { orientation: "v", len: 0.7, x: 1, xanchor: "right", y: 0.5, yanchor: "middle" }) };
    const domain = { x: [0, 1], y: [0, 1] };
    const valued = field !== "turn" || data.bodies.flank.values;
    if (valued && below) domain.y[0] = BAR_HEIGHT / place.clientHeight;
    else if (valued) domain.x[1] = 1 - BAR_WIDTH / place.clientWidth;
    return { bar, domain };
  }

  function traces() {
    const { flank, cam, follower, guide } = data.bodies;
    const stresses = [flank, ...data.moving.map((part) => part.body)].flatMap((body) => body.values || []);
    const limits = { colorscale: "Viridis", cmin: Math.min(...stresses), cmax: Math.max(...stresses) };
    const valued = (body) => body.values && { intensity: body.values, ...limits, lighting: EVEN,
      hovertext: body.words, hoverinfo: "text", flatshading: false };
    const made = [solid(flank, flank.values ? { ...valued(flank), colorbar: arranged().bar } : {}), solid(cam, { color: STEEL, lighting: PLAIN })];
    made.push(solid(data.roller || follower, { color: "#e3e8ed" }));
    made.push({ type: "scatter3d", mode: "lines", x: [], y: [], z: [], hoverinfo: "skip",
      line: { color: MARK, width: 6 } });
    made.push({ type: "scatter3d", mode: "lines", x: [], y: [], z: [], hoverinfo: "skip",
      line: { color: "#444c55", width: 5 } });
    const range = flank.values && { color: rim.of, ...limits };
    made.push({ type: "scatter3d", mode: "lines", x: rim.x, y: rim.y, z: rim.z, hoverinfo: "skip",
      line: { width: 7, ...(range || { color: DARK }) } });
    made.push({ type: "scatter3d", mode: "lines", x: hole.x, y: hole.y, z: hole.z,
      hoverinfo: "skip", line: { width: 2, color: "#59616b" } });
    made.push(solid(data.bodies.bore, { color: "#7d8894", lighting: PLAIN }));
    if (data.roller) made.push(solid(follower, { color: DARK }));
    for (const { body, colour, plain } of data.moving)
      made.push(solid(body, body.values ? { ...valued(body), showscale: false }
        : { color: colour || DARK, lighting: plain ? PLAIN : LIGHT }));
    if (guide) made.push(solid(guide, { color: "#6c7783", opacity: 0.35 }));
    return made;
  }

  const rim = edges(data.bodies.flank, data.bodies.flank.loops || 2), hole = edges(data.bodies.bore, 2);

  /* Coordinates at step n, in the order of the traces. */
  function coordinates(n) {
    const { flank, cam, follower } = data.bodies, turn = data.turn[n];
    const [ox, oy] = [data.origin[0][n], data.origin[1][n]], lean = data.lean ? data.lean[n] : 0;
    const at = (body, angle) => {
      const [x, y] = around(body.x, body.y, angle);
      return [x.map((v) => v + ox), y.map((v) => v + oy)];
    };
    const pairs = [around(flank.x, flank.y, turn), around(cam.x, cam.y, turn)];
    pairs.push(data.roller ? at(data.roller, data.facing[n]) : at(follower, lean));
    const [cx, cy] = [data.contact[0][n], data.contact[1][n]];
    pairs.push([[cx, cx], [cy, cy]]);
    const zs = { 3: [-1.06, 1.06].map((end) => data.contact[2][n] + end * data.half), 4: [] };
    if (data.roller) {
      const spoke = data.roller.spoke, facing = data.facing[n] + Math.PI / 2;
      pairs.push([spoke.map((r) => ox + r * Math.cos(facing)), spoke.map((r) => oy + r * Math.sin(facing))]);
      zs[4] = [1.02 * data.half, 1.02 * data.half];
    } else pairs.push([[], []]);
    for (const line of [rim, hole]) pairs.push(turned(line, turn));
    pairs.push(around(data.bodies.bore.x, data.bodies.bore.y, turn));
    if (data.roller) pairs.push(at(follower, lean));
    for (const { body, turn: turns, x, y, stretch } of data.moving) {
      const [xs, ys] = around(body.x, body.y.map((v) => stretch[n] * v), turns[n]);
      pairs.push([xs.map((v) => v + x[n]), ys.map((v) => v + y[n])]);
    }
    return { pairs, zs };
  }

  const all = traces();
  function placed(n) {
    const { pairs, zs } = coordinates(n);
    pairs.forEach(([x, y], t) => { all[t].x = x; all[t].y = y; if (zs[t]) all[t].z = zs[t]; });
    return pairs.map((_, t) => t);
  }

  const { side, low, top } = data.reach, high = low + top;
  const deep = Math.max(0.3 * high, data.reach.deep), unit = Math.max(2 * side, high) / 1.22;
  const axis = (range) => ({ range, visible: false, autorange: false });
  const layout = () => ({
    margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false, uirevision: "fixed",
    paper_bgcolor: "rgba(0,0,0,0)", font: { color: colour("ink"), family: "system-ui, sans-serif" },
    scene: { domain: arranged().domain, xaxis: axis([-side, side]), yaxis: axis([-low, top]), zaxis: axis([-deep, deep]),
      aspectmode: "manual",
      aspectratio: { x: (2 * side) / unit, y: high / unit, z: (2 * deep) / unit }, dragmode: "orbit", uirevision: "fixed",
      camera: camera("oblique") },
  });

  /* Stress of both bodies at the ends of contact, at their points; pressure on the cam, of its triangles. */
  const PRESSED = [[0, STEEL], [0.008, STEEL], [0.008, "#440154"], [0.25, "#3b528b"], [0.5, "#21918c"], [0.75, "#5ec962"], [1, "#fde725"]];
  function endTraces() {
    const blocks = field === "stress" ? data.ends.blocks : data.ends.blocks.slice(0, 1);
    const values = blocks.map((block) => block[field]);
    const cmax = values.flat().reduce((most, v) => Math.max(most, v), 0);
    return blocks.map((block, n) => solid(block, { intensity: values[n], cmin: 0, cmax, lighting: EVEN,
      intensitymode: field === "stress" ? "vertex" : "cell", colorscale: field === "stress" ? "Viridis" : PRESSED,
      flatshading: field !== "stress", showscale: n === 0, colorbar: arranged().bar,
      hoverinfo: field === "stress" ? "z+text" : "skip",
      hovertext: field === "stress" ? values[n].map((v) => `${v.toPrecision(4)} MPa`) : undefined }));
  }

  function endLayout() {
    const { side: wide, deep } = data.ends.reach, longest = Math.max(2 * deep, 2.4 * wide);
    const share = (size) => (1.5 * size) / longest;
    const base = layout();
    return { ...base, uirevision: "ends", scene: { ...base.scene, uirevision: "ends",
      xaxis: axis([0, wide]), yaxis: axis([-1.2 * wide, 1.2 * wide]), zaxis: axis([-deep, deep]),
      aspectratio: { x: share(wide), y: share(2.4 * wide), z: share(2 * deep) },
      camera: { ...camera("oblique"), eye: { x: -1.5, y: 0.45, z: 0.8 } } } };
  }

  function say(n) {
    const angle = data.angle[n], deg = (v) => v.toFixed(1) + "°";
    const values = data.readout.map((t) => `${t.words} ${Number(t.values[n].toPrecision(4))} ${t.unit}`);
    const place = `cam ${deg(angle)}, ${data.shaft} ${deg(angle * data.ratio)}`;
    readout.textContent = [place, ...values].join(" · ");
    slider.setAttribute("aria-valuetext", place);
  }

  let wanted = 0, drawing = false, playing = 0;
  function show(n) {
    wanted = n;
    say(n);
    if (drawing) return;
    drawing = true;
    const now = wanted, moving = placed(now);
    const update = { x: moving.map((t) => all[t].x), y: moving.map((t) => all[t].y), z: moving.map((t) => all[t].z) };
    Plotly.restyle(place, update, moving).then(() => {
      drawing = false;
      place.dataset.shown = String(now);
      if (now !== wanted) show(wanted);
    });
  }

  function step() {
    if (!playing) return;
    if (!drawing) {
      slider.value = String((Number(slider.value) + 2) % data.angle.length);
      show(Number(slider.value));
    }
    playing = requestAnimationFrame(step);
  }

  if (!webgl()) {
    document.getElementById("failed").hidden = false;
    place.hidden = true;
    say(0);
    slider.addEventListener("input", () => say(Number(slider.value)));
    return;
  }
  const draw = () => Plotly.newPlot(place, field === "turn" ? all : endTraces(),
    field === "turn" ? layout() : endLayout(), { displaylogo: false, responsive: true, displayModeBar: false });
  say(0);  // before the drawing: its lines take height from it
  placed(0);
  draw().then(() => { place.dataset.shown = "0"; });
  slider.addEventListener("input", () => show(Number(slider.value)));
  function run(on) {
    play.setAttribute("aria-pressed", String(on));
    play.textContent = on ? "Pause" : "Play";
    if (on) playing = requestAnimationFrame(step);
    else { cancelAnimationFrame(playing); playing = 0; }
  }
  play.addEventListener("click", () => run(!playing));
  const choices = document.querySelectorAll("[data-field]");
  for (const choice of choices)
    choice.addEventListener("click", () => {
      field = choice.dataset.field;
      run(false);
      for (const other of choices) other.setAttribute("aria-pressed", String(other === choice));
      const atEnds = field !== "turn";
      document.getElementById("of-turn").hidden = atEnds;
      document.getElementById("of-ends").hidden = !atEnds;
      for (const control of [play, slider]) control.disabled = atEnds;
      if (atEnds) readout.textContent = data.ends.words;
      else say(Number(slider.value));
      draw().then(() => { place.dataset.field = field; });
    });
  addEventListener("resize", () => Plotly.relayout(place, { "scene.domain": arranged().domain }));
  narrow.addEventListener("change", () => {
    if (all[0].colorbar && field === "turn") all[0].colorbar = arranged().bar;
    draw();
  });
  for (const button of document.querySelectorAll("[data-view]"))
    button.addEventListener("click", () => Plotly.relayout(place, { "scene.camera": camera(button.dataset.view) }));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () =>
    Plotly.relayout(place, { "font.color": colour("ink") }));
})();
