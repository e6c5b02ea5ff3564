"use strict";
// lets lines of a chart swing between both sides: mode shapes; on paper they stand swung out
(function () {
  const PERIOD = 1800; // ms
  const STILL = matchMedia("(prefers-reduced-motion: reduce)");

  function start(place, { trace, x, y, dx, dy }) {
    let begun = null;
    const button = document.createElement("button");
    button.type = "button";
    button.className = "copy swing";

    function draw(part) {
      const at = (rest, out) => rest.map((value, k) => (value === null ? null : value + part * out[k]));
      return Plotly.restyle(place, { x: [at(x, dx)], y: [at(y, dy)] }, [trace]);
    }

    function step(now) {
      if (begun === null) return;
      if (!place.isConnected || place.closest("details:not([open])")) return stop();
      // it begins where it stands, swung out
      draw(Math.cos((2 * Math.PI * (now - begun)) / PERIOD)).then(() => requestAnimationFrame(step));
    }

    function stop() {
      begun = null;
      button.textContent = "let it swing";
      button.setAttribute("aria-pressed", "false");
      if (place.data) draw(1);
    }

    function go() {
      begun = performance.now();
      button.textContent = "stop";
      button.setAttribute("aria-pressed", "true");
      requestAnimationFrame(step);
    }

    button.addEventListener("click", () => (begun === null ? go() : stop()));
    window.addEventListener("beforeprint", stop);
    stop();
    place.after(button);
    return { go, stop };
  }

  const shapes = [];
  for (const data of document.querySelectorAll("script[data-chart]")) {
    const { swing } = JSON.parse(data.textContent);
    const place = document.getElementById(data.dataset.chart);
    if (swing && typeof Plotly !== "undefined") shapes.push({ place, ...start(place, swing), seen: false });
  }
  // the first that comes into view moves by itself, so that a reader sees that they can
  function begin() {
    const first = shapes.find(({ place }) => !place.closest("details:not([open])"));
    if (!first || first.seen || STILL.matches) return;
    first.seen = true;
    setTimeout(first.go, 400);
  }
  document.addEventListener("toggle", begin, true);
  begin();
})();
