"use strict";
// A button stops the turning cams of a page; those out of sight stand still by themselves.
const cams = [...document.querySelectorAll(".turning-cam:not(.still)")];
if (cams.length && !matchMedia("(prefers-reduced-motion: reduce)").matches) {
  const button = document.createElement("button");
  button.className = "pause";
  button.type = "button";
  const stop = (paused) => {
    document.body.classList.toggle("paused", paused);
    button.setAttribute("aria-pressed", String(paused));
    button.textContent = paused ? cams.length > 1 ? "Turn the cams" : "Turn" : cams.length > 1 ? "Stop the cams" : "Stop";
  };
  button.addEventListener("click", () => stop(!document.body.classList.contains("paused")));
  stop(false);
  const list = cams[0].closest("ul.cams");
  if (list) list.before(button);
  else cams[0].after(button);
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) entry.target.classList.toggle("away", !entry.isIntersecting);
  });
  for (const cam of cams) seen.observe(cam);
}
