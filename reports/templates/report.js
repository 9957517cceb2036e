"use strict";
/* Draws the figures by Plotly in place of the static drawings, which remain for print. */
(function () {
  if (!window.Plotly) return;
  const specs = JSON.parse(document.getElementById("figure-data").textContent);
  const config = { displayModeBar: false, responsive: false };
  const colour = (name) =>
    getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim() || name;
  const faded = (name, share) => {
    const code = colour(name);
    return /^#[0-9a-f]{6}$/i.test(code) ? code + share : code;
  };

  function themed(spec) {
    const data = spec.data.map((trace) => {
      const line = trace.line && { ...trace.line, color: colour(trace.line.color) };
      const marker = trace.marker && { ...trace.marker, color: colour(trace.marker.color) };
      const fill = trace.fillcolor && /* areas opaque, ribbons pale */
        (trace.fill === "toself" ? colour(trace.fillcolor) : faded(trace.fillcolor, "2e"));
      const over = spec.x && !trace.x && { x: spec.x, customdata: spec.cam }; /* the turn */
      return { ...trace, ...over, ...(line && { line }), ...(marker && { marker }), ...(fill && { fillcolor: fill }) };
    });
    const ink = colour("ink"), muted = colour("muted"), grid = colour("grid");
    const layout = {
      hovermode: "x unified", hoversubplots: "axis", margin: { l: 64, r: 14, t: 40, b: 46 },
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", dragmode: false,
      font: { color: ink, size: 11, family: "system-ui, sans-serif" },
      legend: { orientation: "h", x: 0, y: 1, yref: "container", yanchor: "top",
        traceorder: "normal" },
      hoverlabel: { bgcolor: colour("card"), font: { color: ink } }, ...spec.layout };
    for (const key of Object.keys(layout).filter((k) => /^[xy]axis/.test(k)))
      layout[key] = { gridcolor: grid, linecolor: muted, zerolinecolor: muted, tickcolor: muted,
        automargin: false, showgrid: key[0] === "y" || !layout.xaxis2, ...layout[key] };
    layout.shapes = layout.shapes.map((shape) => ({ ...shape,
      ...(shape.fillcolor && { fillcolor: colour(shape.fillcolor) }),
      line: { ...shape.line, ...(shape.line.color && { color: colour(shape.line.color) }) } }));
    layout.annotations = layout.annotations.map((note) => ({ ...note,
      ...(note.bgcolor && { bgcolor: faded("card", "bf") }), font: { ...note.font, color: colour(note.font.color) } }));
    return { data, layout };
  }

  function readout(spec, data, index) {
    const plain = (text) => new DOMParser().parseFromString(text, "text/html").body.textContent;
    const curves = data.filter((trace) => trace.hovertemplate && trace.x.length > index);
    if (!curves.length) return "";
    const at = spec.at || { name: "cam angle", unit: "degrees" };
    const where = (at.name + " " + (spec.at ? curves[0].customdata[index] :
      curves[0].customdata[index].toFixed(1)) + " " + at.unit).trimEnd() + ": ";
    return where + curves.map((trace) => plain(trace.name) + " " +
      (trace.y[index] === null ? "unknown" : trace.y[index] + " " + plain(trace.meta))).join("; ");
  }

  function keyboard(place, spec, data) {
    let index = 0;
    const first = data.findIndex((trace) => trace.hovertemplate);
    const output = place.parentNode.querySelector(".readout");
    place.addEventListener("keydown", (event) => {
      const count = data[first].x.length;
      const steps = { ArrowRight: 1, ArrowLeft: -1, PageUp: 10, PageDown: -10 };
      if (event.key === "Home") index = 0;
      else if (event.key === "End") index = count - 1;
      else if (event.key in steps) index = (index + steps[event.key] + count) % count;
      else return;
      event.preventDefault();
      Plotly.Fx.hover(place, [{ curveNumber: first, pointNumber: index }]);
      output.textContent = readout(spec, data, index);
    });
    place.addEventListener("blur", () => Plotly.Fx.unhover(place));
  }

  /* Screen readers skip the drawing; its container has a name and a live region for values. */
  const mute = (...elements) =>
    elements.forEach((one) => one && one.setAttribute("aria-hidden", "true"));

  /* Space for a legend that wraps on a narrow screen. */
  function fitLegend(place, layout) {
    const legend = place.querySelector(".infolayer > .legend");
    const more = legend ? Math.max(Math.ceil(legend.getBoundingClientRect().height) - 30, 0) : 0;
    const top = layout.margin.t + more;
    if (place.layout.margin.t !== top)
      return Plotly.relayout(place, { "margin.t": top, height: layout.height + more });
  }

  /* Line at the angle of the slider, beside the drawing of Plotly, which it does not redraw. */
  let shaft = null;
  function mark(place) {
    const line = place.parentNode.querySelector(".cursor"), full = place._fullLayout;
    if (!line || !full || shaft === null) return;
    line.style.left = `${full._size.l + full.xaxis.d2p(shaft)}px`;
    line.style.top = `${full._size.t}px`;
    line.style.height = `${full._size.h}px`;
  }

  for (const hint of document.querySelectorAll(".pointing")) hint.hidden = false;
  const places = [...document.querySelectorAll(".live")].filter((p) => specs[p.dataset.figure]);
  function drawn(place) {
    if (place.dataset.drawn) return;
    place.dataset.drawn = "begun";
    const spec = specs[place.dataset.figure], made = themed(spec);
    place.hidden = false;
    Plotly.newPlot(place, made.data, made.layout, config).then(() => {
      place.parentNode.classList.add("interactive");
      fitLegend(place, made.layout);
      if (spec.x) {
        place.append(Object.assign(document.createElement("div"), { className: "cursor" }));
        place.on("plotly_afterplot", () => mark(place));
        mark(place);
      }
      mute(...place.children, document.getElementById("js-plotly-tester"));
      place.dataset.drawn = "done";
      keyboard(place, spec, made.data);
    }).catch((error) => { place.hidden = true; console.error(error); });
  }

  const watcher = new IntersectionObserver((entries) => entries.forEach((entry) => {
    if (!entry.isIntersecting) return;
    watcher.unobserve(entry.target);
    drawn(entry.target.querySelector(".live"));
  }), { rootMargin: "400px" });
  places.forEach((place) => watcher.observe(place.parentNode));
  /* One figure a task: a key or click comes between two. An idle callback would wait for a frame. */
  const rest = [...places];
  (function next() {
    const place = rest.shift();
    if (place) setTimeout(() => { drawn(place); next(); }, 0);
  })();
  const ready = () => places.filter((place) => place.dataset.drawn === "done");
  document.addEventListener("cam-angle", (event) => {
    shaft = event.detail;
    ready().forEach(mark);
  });
  /* Colours and width, which may change together: one redraw after the last of both. */
  let later = 0, recoloured = false;
  function redraw() {
    ready().filter((place) => place.clientWidth).forEach((place) => {
      const made = themed(specs[place.dataset.figure]);
      const drawing = recoloured ? Plotly.react(place, made.data, made.layout, config) :
        Promise.resolve();
      /* A width, since Plotly resizes no figure whose height has been changed for its legend. */
      drawing.then(() => Plotly.relayout(place, { width: place.clientWidth }))
        .then(() => fitLegend(place, made.layout));
    });
    recoloured = false;
  }
  const soon = () => { clearTimeout(later); later = setTimeout(redraw, 200); };
  addEventListener("resize", soon);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    recoloured = true;
    soon();
  });
})();
