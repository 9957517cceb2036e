"use strict";
/* Live preview: sliders over numbers of the design, and the figures that follow by polynomials. */
(function () {
  const source = document.getElementById("live-data");
  if (!source) return;
  const data = JSON.parse(source.textContent), section = document.getElementById("live");
  const status = document.getElementById("live-status"), changes = document.getElementById("live-toml");
  const digits = (value, count) => Number(value.toPrecision(count));
  const first = (factor) => Object.values(factor.keys)[0];
  const fields = data.factors.map((factor, k) => {
    const slider = document.getElementById(`live-${k}`), entry = document.getElementById(`live-${k}-value`);
    return { factor, slider, entry, run: first(factor), value: first(factor) };
  });

  /* Products of Chebyshev polynomials at places in [-1, 1], one a term. */
  function terms(places) {
    const most = Math.max(...data.powers.flat()), table = places.map((z) => {
      const row = [1, z];
      for (let k = 2; k <= most; k++) row.push(2 * z * row[k - 1] - row[k - 2]);
      return row;
    });
    return data.powers.map((degrees) => degrees.reduce((product, k, axis) => product * table[axis][k], 1));
  }

  /* Value and error of a surface, of the products of its terms. */
  function at(surface, products) {
    let value = surface.coefficients[0];
    if (surface.coefficients.length > 1) {
      value = surface.coefficients.reduce((sum, c, k) => sum + c * products[k], 0);
      if (surface.scale === "log") value = Math.exp(value);
      if (surface.scale === "square") value = Math.sqrt(Math.max(value, 0));
    }
    return { value, error: surface.error * (surface.share ? Math.abs(value) : 1) };
  }

  /* A quantity at a setting: the worst of its load cases; why it does not hold there. */
  function quantity(one, products, contacts) {
    const sign = one.worst === "greatest" ? 1 : -1, parts = [], lost = new Set();
    let doubt = "";
    for (const part of one.parts) {
      const name = part.state < 0 ? "" : data.states[part.state];
      const near = part.loads.filter((state) => Math.abs(contacts.get(state).value) <= contacts.get(state).error);
      if (near.length) doubt = `the follower may leave the cam, ${data.states[near[0]]}`;
      const without = part.loads.filter((state) => contacts.get(state).value <= 0);
      without.forEach((state) => lost.add(data.states[state]));
      if (without.length) continue;
      if (!part.surface) doubt = `not known, ${name}`;
      else parts.push({ name, ...at(part.surface, products) });
    }
    parts.sort((a, b) => sign * (b.value - a.value));
    const worst = parts[0];
    if (!worst) return { doubt: doubt || `the follower leaves the cam, ${[...lost].join(", ")}` };
    const error = Math.max(...parts.map((part) => part.error));
    const rival = parts.find((part) => part !== worst && sign * (worst.value - part.value) <= error);
    const limit = one.limit && at(one.limit, products);
    const used = limit === null ? null : sign > 0 ? worst.value / limit.value :
      worst.value > 0 ? limit.value / worst.value : Infinity;
    const atLimit = limit !== null && Math.abs(worst.value - limit.value) <= error + limit.error;
    return { ...worst, error, atLimit, used, doubt, rival: rival && rival.name !== worst.name ? rival.name : "" };
  }

  function all(values) {
    const places = fields.map(({ factor, run }, k) => {
      const low = Math.log(factor.low), high = Math.log(factor.high);
      return (2 * Math.log(values[k] / run) - low - high) / (high - low);
    });
    const products = terms(places);
    const contacts = new Map(data.contact.map((part) => [part.state, at(part.surface, products)]));
    return { places, contacts, figures: data.quantities.map((one) => quantity(one, products, contacts)) };
  }

  /* A value to the digits that its error leaves, and the error to two. */
  function worded(figure) {
    const decade = (value) => value ? Math.floor(Math.log10(Math.abs(value))) : 0;
    const least = figure.error ? 1 - decade(figure.error) : 6; /* and no more than five digits */
    const places = Math.min(Math.max(Math.min(least, 4 - decade(figure.value)), 0), 6);
    return [figure.value.toFixed(places), `± ${digits(figure.error, 2)}`];
  }

  const atRun = all(fields.map((field) => field.run));
  const rows = data.quantities.map((one) => section.querySelector(`[data-quantity="${one.id}"]`));
  const cell = (row, name) => row.querySelector(`[data-cell="${name}"]`);
  const safety = (used) => used === Infinity ? "0" : used > 0 ? digits(1 / used, 3).toString() : "–";
  rows.forEach((row, k) => {
    const run = atRun.figures[k];
    cell(row, "run").textContent = run.value === undefined ? "–" :
      run.used === null ? worded(run)[0] : safety(run.used);
  });

  function shown(row, one, figure, outside) {
    const none = outside || figure.value === undefined || figure.doubt;
    row.classList.toggle("unheld", Boolean(none));
    const [value, error] = none ? ["–", ""] : worded(figure);
    cell(row, "value").textContent = value;
    cell(row, "error").textContent = error;
    cell(row, "why").textContent = outside ? "" : figure.doubt ||
      (figure.rival ? `${figure.name}, about equal: ${figure.rival}` : figure.name);
    if (one.limit === null) return;
    const used = none ? 0 : figure.used, bar = row.querySelector(".bar");
    cell(row, "safety").textContent = none ? "–" : safety(used);
    bar.classList.toggle("over", used >= 1.5);
    bar.classList.toggle("beyond", used > 1);
    bar.firstElementChild.style.width = `${Math.min(used / 1.5, 1) * 100}%`;
    cell(row, "over").textContent = !none && figure.atLimit ? "at the limit within the error" : used > 1 ? "over the limit" : "";
  }

  function follow() {
    const { places, contacts, figures } = all(fields.map((field) => field.value));
    const out = fields.filter((field, k) => !(Math.abs(places[k]) <= 1 + 1e-9));
    figures.forEach((figure, k) => shown(rows[k], data.quantities[k], figure, out.length > 0));
    const lost = data.contact.filter((part) => contacts.get(part.state).value <= 0)
      .map((part) => data.states[part.state]);
    const checks = figures.filter((_, k) => data.quantities[k].limit !== null);
    const valued = checks.filter((check) => check.value !== undefined && !check.doubt);
    const over = valued.filter((check) => check.used > 1).length, without = checks.length - valued.length;
    const words = out.length ? [`Outside the fitted range, where nothing holds: ${
      out.map((field) => field.factor.name).join(", ")}.`] : [
      `${over || "None"} of ${valued.length} followed checks ${over === 1 ? "is" : "are"} over ${
      over === 1 ? "its" : "their"} limit${without ? `, ${without} without a value here` : ""}. Preview, no verdict.`];
    if (!out.length && lost.length) words.push(`The follower leaves the cam: ${lost.join(", ")}; no figure rests on its loads.`);
    status.textContent = words.join(" ");
    status.classList.toggle("remark", out.length > 0 || lost.length > 0);
    changes.hidden = true;
  }

  function set(field, value, typed) {
    field.value = value;
    const { low, high } = field.factor, share = Math.log(value / field.run / low) / Math.log(high / low);
    if (typed) field.slider.value = Math.round(share * data.steps);
    else field.entry.value = digits(value, 6);
    field.slider.setAttribute("aria-valuetext", `${value} ${field.factor.unit}`);
  }

  function back(field) {
    set(field, field.run, true);
    set(field, field.run, false);
  }

  /* Value at a step; the step nearest to the value of the run is that value. */
  function stepped(field) {
    const { low, high } = field.factor, at = (step) => low * (high / low) ** (step / data.steps);
    const step = Number(field.slider.value), run = Math.round(Math.log(1 / low) / Math.log(high / low) * data.steps);
    return step === run ? field.run : digits(field.run * at(step), 4);
  }

  /* Folder of the run, and a file beside it, which adds none to the run. */
  const home = decodeURIComponent(location.pathname).split("/").slice(-2)[0] || "run";

  /* A study of one design, with the command that runs it. */
  function study() {
    const changed = fields.filter((field) => field.value !== field.run);
    const text = (words) => JSON.stringify(words);
    const keys = changed.flatMap(({ factor, value, run }) => Object.entries(factor.keys).map(([key, own]) =>
      `\n[[factor]]\nkey = ${text(key)}\nlist = [${text(`${digits(own * value / run, 8)} ${factor.unit}`.trim())}]` +
      `    # in the run ${digits(own, 8)} ${factor.unit}\n`));
    return [`schema_version = 1\nname = "changes"\ncase = ${text(`${home}/case.toml`)}\ndepth = "preview"\n` +
      (data.lift === "run" ? `cam = "base"    # the lift as it was ground; without this line, one of its own\n` : "") +
      `${keys.join("")}\n[sampling]\nmethod = "list"\n`, "camwright study run changes.toml --out changes"];
  }

  for (const field of fields) {
    field.slider.max = data.steps;
    back(field);
    field.slider.addEventListener("input", () => { set(field, stepped(field), false); follow(); });
    field.entry.addEventListener("input", () => {
      const value = field.entry.valueAsNumber;
      if (!(value > 0)) return;
      set(field, value === digits(field.run, 6) ? field.run : value, true);
      follow();
    });
  }
  section.querySelector("form").addEventListener("submit", (event) => event.preventDefault());
  document.getElementById("live-reset").addEventListener("click", () => {
    fields.forEach(back);
    follow();
  });
  document.getElementById("live-show").addEventListener("click", () => {
    const [toml, command] = study(), changed = fields.some((field) => field.value !== field.run);
    changes.hidden = false;
    changes.querySelector("p").textContent = changed ?
      `Save as changes.toml beside the folder ${home} and run the command there; it needs camwright[study].` : "Nothing is changed.";
    const [block, line] = changes.querySelectorAll("pre");
    block.textContent = changed ? toml : "";
    line.textContent = changed ? command : "";
    block.hidden = line.hidden = !changed;
    changes.focus();
  });
  window.livePreview = { all, names: data.quantities.map((one) => one.id) };
  section.hidden = false;
  for (const link of document.querySelectorAll("[href='#live']")) link.hidden = false;
  follow();
})();
