"use strict";
// shows deformed models: turned, scaled, cut, coloured by value, with values where one points
(function () {
  const STOPS = ["440154", "482878", "3e4a89", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"];
  const PARTS = ["#9db3c9", "#e8a33d", "#6fa48f", "#cc79a7", "#56b4e9", "#d55e00", "#999933", "#44aa99"];
  const rgb = (hex) => [0, 2, 4].map((k) => parseInt(hex.replace("#", "").slice(k, k + 2), 16) / 255);
  const VERTEX = `#version 300 es
    in vec3 position, displacement; in float stress;
    uniform vec3 middle, target, right, up, toward; uniform float reach, largest, factor, zoom, aspect;
    uniform int colours;
    out vec3 place; out float value;
    void main() {
      vec3 moved = displacement * largest;
      place = middle + reach * position + factor * moved;
      value = colours == 1 ? length(displacement) : stress;
      vec3 seen = place - target;
      gl_Position = vec4(dot(seen, right) * zoom / aspect, dot(seen, up) * zoom, -dot(seen, toward) / (8.0 * reach), 1.0);
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float; precision highp int;
    in vec3 place; in float value;
    uniform vec3 part, stops[10], right, up, toward; uniform vec4 cut; uniform vec2 range; uniform int colours;
    out vec4 colour;
    void main() {
      if (dot(cut.xyz, place) > cut.w) discard;
      vec3 own = part;
      if (colours > 0) {
        float t = 9.0 * clamp((value - range.x) / max(range.y - range.x, 1e-12), 0.0, 1.0);
        int k = int(min(t, 8.0));
        own = mix(stops[k], stops[k + 1], t - float(k));
      }
      vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
      float light = 0.55 + 0.45 * abs(dot(normal, normalize(toward + 0.5 * up - 0.3 * right)));
      if (!gl_FrontFacing) own = mix(own, vec3(0.35), 0.55);
      colour = vec4(own * light, 1.0);
    }`;

  function unpacked(text, Kind) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Kind(bytes.buffer);
  }

  function program(gl) {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    return gl.getProgramParameter(made, gl.LINK_STATUS) ? made : null;
  }

  const element = function (name, properties, ...inner) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...inner);
    return made;
  };
  const labelled = (text, control) => element("label", {}, text + " ", control);
  const digits = (value) => (value === 0 ? "0" : Number(value.toPrecision(3)).toString());

  function start(place, text) {
    const canvas = element("canvas", { tabIndex: 0 });
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    const made = gl && program(gl);
    if (!made) return;
    const data = JSON.parse(text);
    const still = place.parentElement.querySelector("img");
    const arrays = { position: unpacked(data.positions, Int16Array) };
    const buffers = {};
    let load = null; // the one that is shown
    const triangles = unpacked(data.triangles, Uint32Array);
    const home = { yaw: -2.1, pitch: 0.35, zoom: 1, target: data.middle };
    const sides = [0, 0, 0]; // half lengths of the box round the model
    arrays.position.forEach((value, k) => { sides[k % 3] = Math.max(sides[k % 3], (data.reach * Math.abs(value)) / 32767); });
    const state = { ...home, factor: 0, colours: 1, axis: -1, at: 0.5, hidden: new Set() };
    let kinds = [];
    let range = [0, 1];

    canvas.setAttribute("role", "application");
    canvas.setAttribute("aria-label", "Model in three dimensions: drag or arrow keys turn it, plus and minus scale it, Enter reads the value in the middle");
    gl.useProgram(made);
    function upload(name) {
      const at = gl.getAttribLocation(made, name);
      buffers[name] ??= gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, arrays[name], gl.STATIC_DRAW);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, name === "stress" ? 1 : 3, gl.SHORT, true, 0, 0);
    }
    function show(number) {
      load = data.loads[number];
      arrays.displacement = unpacked(load.displacements, Int16Array);
      arrays.stress = unpacked(load.stresses, Int16Array);
      ["displacement", "stress"].forEach(upload);
      kinds = [
        null,
        { name: "displacement", unit: "mm", whole: 1e3 * load.largest },
        { name: "von Mises stress", unit: "MPa", whole: 1e-6 * load.greatest },
      ];
    }
    upload("position");
    show(0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    gl.enable(gl.DEPTH_TEST);
    const uniform = (name) => gl.getUniformLocation(made, name);

    function basis({ yaw, pitch } = state) {
      const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
      return { toward: [cp * cy, cp * sy, sp], right: [-sy, cy, 0], up: [-sp * cy, -sp * sy, cp] };
    }

    // so that the first view shows all of the model
    function zoom() {
      const { right, up } = basis(home);
      const half = (axis) => axis.reduce((sum, value, k) => sum + Math.abs(value) * sides[k], 0);
      return 0.85 * state.zoom * Math.min(canvas.clientWidth / canvas.clientHeight / half(right), 1 / half(up));
    }

    function plane() {
      // what lies beyond is cut away
      if (state.axis < 0) return [0, 0, 0, 1];
      const normal = [0, 0, 0];
      normal[state.axis] = 1;
      return [...normal, data.middle[state.axis] + data.reach * (2 * state.at - 1)];
    }

    function draw() {
      const scale = window.devicePixelRatio || 1;
      const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(1, Math.round(n * scale)));
      if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
      gl.viewport(0, 0, width, height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      for (const [name, value] of Object.entries({ ...basis(), middle: data.middle, target: state.target })) gl.uniform3fv(uniform(name), value);
      for (const [name, value] of Object.entries({ reach: data.reach, largest: load.largest, factor: state.factor, zoom: zoom(), aspect: width / height })) gl.uniform1f(uniform(name), value);
      gl.uniform1i(uniform("colours"), state.colours);
      gl.uniform2fv(uniform("range"), range);
      gl.uniform4fv(uniform("cut"), plane());
      gl.uniform3fv(uniform("stops"), STOPS.flatMap(rgb));
      data.parts.forEach(function (part, k) {
        if (state.hidden.has(k)) return;
        gl.uniform3fv(uniform("part"), rgb(PARTS[k % PARTS.length]));
        gl.drawElements(gl.TRIANGLES, 3 * part.count, gl.UNSIGNED_INT, 12 * part.first);
      });
    }

    // the nearest triangle under a point of the canvas, from -1 to 1 across and up
    function under(across, upward) {
      const { toward, right, up } = basis();
      const cut = plane();
      const aspect = canvas.width / canvas.height;
      const [x, y] = [(across * aspect) / zoom(), upward / zoom()];
      const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      const whole = 32767;
      const vertex = function (k) {
        const p = [0, 1, 2].map((c) => data.middle[c] + (data.reach * arrays.position[3 * k + c]) / whole);
        const u = [0, 1, 2].map((c) => (load.largest * arrays.displacement[3 * k + c]) / whole);
        const moved = p.map((value, c) => value + state.factor * u[c]);
        const seen = moved.map((value, c) => value - state.target[c]);
        return { p, u, moved, s: arrays.stress[k] / whole, x: dot(seen, right), y: dot(seen, up), z: dot(seen, toward) };
      };
      const cache = new Map();
      const known = (k) => cache.get(k) ?? (cache.set(k, vertex(k)), cache.get(k));
      let best = null;
      data.parts.forEach(function (part, number) {
        if (state.hidden.has(number)) return;
        for (let t = part.first; t < part.first + part.count; t++) {
          const [a, b, c] = [0, 1, 2].map((k) => known(triangles[3 * t + k]));
          const area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
          const v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
          const w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
          if (!(v >= 0 && w >= 0 && v + w <= 1)) continue;
          const mix = (of) => (1 - v - w) * of(a) + v * of(b) + w * of(c);
          const depth = mix((n) => n.z);
          if (best && depth <= best.depth) continue;
          const moved = [0, 1, 2].map((k) => mix((n) => n.moved[k]));
          if (dot(cut, moved) > cut[3]) continue;
          const point = [0, 1, 2].map((k) => mix((n) => n.p[k]));
          const u = Math.hypot(...[0, 1, 2].map((k) => mix((n) => n.u[k])));
          best = { depth, part: part.name, point, u, s: mix((n) => n.s) };
        }
      });
      return best;
    }

    const read = element("output", { textContent: "Click on the model to read a value." });
    function pick(across, upward) {
      const found = under(across, upward);
      read.textContent = found
        ? `${found.part.replaceAll("_", " ")} at x ${digits(found.point[0])}, y ${digits(found.point[1])}, z ${digits(found.point[2])} m: displacement ${digits(1e3 * found.u)} mm, von Mises stress ${digits(1e-6 * load.greatest * found.s)} MPa`
        : "There is nothing at that point.";
    }

    // controls
    const bar = element("span", { className: "bar" });
    bar.style.background = `linear-gradient(to right, ${STOPS.map((stop) => "#" + stop).join(", ")})`;
    const ends = ["least", "most"].map((name) => {
      const control = element("input", { type: "number", step: "any" });
      control.setAttribute("aria-label", `${name} value of the colours`);
      return control;
    });
    const unit = element("span", {});
    const legend = element("span", { className: "range" }, ends[0], bar, ends[1], unit);
    function showRange() {
      const kind = kinds[state.colours];
      legend.hidden = !kind;
      if (!kind) return;
      unit.textContent = " " + kind.unit;
      ends.forEach((end, k) => { end.value = digits(range[k] * kind.whole); });
    }
    ends.forEach((end, k) => end.addEventListener("change", function () {
      const value = Number(end.value) / kinds[state.colours].whole;
      if (Number.isFinite(value)) range[k] = value;
      draw();
    }));
    const colours = element("select", {}, ...["part", "displacement", "von Mises stress"].map((name, value) => element("option", { value, textContent: name })));
    colours.value = "1";
    colours.addEventListener("change", function () {
      state.colours = Number(colours.value);
      range = [0, 1];
      showRange();
      draw();
    });
    const times = element("output", {});
    const factor = element("input", { type: "range", min: 0, max: 3, step: 0.05, value: 1 });
    const scaled = function () {
      state.factor = load.factor * Number(factor.value);
      times.textContent = ` ${digits(state.factor)} times`;
    };
    const loads = element("select", {}, ...data.loads.map(({ name }, value) => element("option", { value, textContent: name })));
    loads.addEventListener("change", function () {
      show(Number(loads.value));
      range = [0, 1];
      scaled();
      showRange();
      read.textContent = "Click on the model to read a value.";
      draw();
    });
    factor.addEventListener("input", function () { scaled(); draw(); });
    const axis = element("select", {}, ...["none", "x", "y", "z"].map((name, k) => element("option", { value: k - 1, textContent: name })));
    const at = element("input", { type: "range", min: 0, max: 1, step: 0.005, value: 0.5, disabled: true });
    at.setAttribute("aria-label", "place of the cut");
    axis.addEventListener("change", function () {
      state.axis = Number(axis.value);
      at.disabled = state.axis < 0;
      draw();
    });
    at.addEventListener("input", function () { state.at = Number(at.value); draw(); });
    const boxes = data.parts.map(function (part, k) {
      const box = element("input", { type: "checkbox", checked: true });
      box.addEventListener("change", function () {
        if (box.checked) state.hidden.delete(k);
        else state.hidden.add(k);
        draw();
      });
      const label = element("label", {}, box, " " + part.name.replaceAll("_", " "));
      label.style.borderBottom = `3px solid ${PARTS[k % PARTS.length]}`;
      return label;
    });
    const reset = element("button", { type: "button", className: "filter", textContent: "first view" });
    reset.addEventListener("click", function () { Object.assign(state, home); draw(); });
    place.append(
      element("div", { className: "controls" }, ...(data.loads.length > 1 ? [labelled("Load", loads)] : []), labelled("Colour", colours), legend, labelled("Deformation", factor), times, labelled("Cut across", axis), at, ...boxes, reset),
      canvas,
      read,
    );

    // turning, moving, scaling
    let last = null;
    let moved = false;
    canvas.addEventListener("pointerdown", function (event) {
      canvas.setPointerCapture(event.pointerId);
      last = [event.clientX, event.clientY];
      moved = false;
    });
    const turn = function (across, down) {
      state.yaw -= across;
      state.pitch = Math.max(-1.57, Math.min(1.57, state.pitch + down));
    };
    canvas.addEventListener("pointermove", function (event) {
      if (!last) return;
      const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
      if (!moved && Math.hypot(dx, dy) < 3) return;
      moved = true;
      last = [event.clientX, event.clientY];
      if (event.shiftKey) {
        const { right, up } = basis();
        const step = 2 / (canvas.clientHeight * zoom());
        state.target = state.target.map((value, k) => value - step * (dx * right[k] - dy * up[k]));
      } else turn(dx / 150, dy / 150);
      draw();
    });
    canvas.addEventListener("pointerup", function (event) {
      const box = canvas.getBoundingClientRect();
      if (last && !moved) pick((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
      last = null;
    });
    canvas.addEventListener("pointercancel", () => { last = null; });
    canvas.addEventListener("wheel", function (event) {
      if (document.activeElement !== canvas && !event.ctrlKey) return; // the page scrolls
      event.preventDefault();
      state.zoom *= Math.exp(-event.deltaY / 600);
      draw();
    }, { passive: false });
    const keys = {
      ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, -0.1), ArrowDown: () => turn(0, 0.1),
      "+": () => { state.zoom *= 1.15; }, "-": () => { state.zoom /= 1.15; }, Enter: () => pick(0, 0),
    };
    canvas.addEventListener("keydown", function (event) {
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
      draw();
    });

    if (still) still.closest(".picture").classList.add("for-paper");
    place.hidden = false;
    scaled();
    showRange();
    new ResizeObserver(draw).observe(canvas);
    window.addEventListener("beforeprint", function () {
      if (still) return;
      draw();
      place.after(element("img", { className: "for-paper", src: canvas.toDataURL(), alt: "The model as it was turned" }));
    });
  }

  // a browser has only a few contexts of WebGL: one in a fold is taken when that is opened
  let waiting = Array.from(document.querySelectorAll("script[data-solid]"));
  function startThose() {
    const [ready, later] = [[], []];
    for (const data of waiting) (data.closest("details:not([open])") ? later : ready).push(data);
    waiting = later;
    for (const data of ready) start(document.getElementById(data.dataset.solid), data.textContent);
  }
  startThose();
  document.addEventListener("toggle", startThose, true);
})();
