"use strict";
// draws the charts, in the colours of the page: light, dark, or those of paper
(function () {
  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: window.innerWidth < 640 ? false : "hover",
    // no button that sends the data anywhere
    showSendToCloud: false,
    plotlyServerURL: "",
    modeBarButtonsToRemove: ["lasso2d", "select2d", "sendChartToCloud", "toImage"],
  };
  if (typeof Plotly !== "undefined") {
    config.modeBarButtonsToAdd = [{ name: "save as PNG", icon: Plotly.Icons.camera, click: savePicture }];
  }
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const inks = new Set(["black", "#000", "#000000", "#1f2933"]);
  const axis = { linecolor: "#a9b4c0", tickcolor: "#a9b4c0", gridcolor: "#39424d", zerolinecolor: "#6b7785" };
  const axes = /^[xyz]axis\d*$|^polar$|^radialaxis$|^angularaxis$/;

  function lit(value) {
    if (typeof value === "string") return inks.has(value.toLowerCase()) ? "#e6eaef" : value;
    if (Array.isArray(value)) return value.length && typeof value[0] === "number" ? value : value.map(lit);
    if (value === null || typeof value !== "object") return value;
    return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, lit(inner)]));
  }

  function onDark(figure) {
    const { data, layout } = lit(figure);
    const look = layout.template.layout;
    Object.assign(look, { paper_bgcolor: "#14191f", plot_bgcolor: "#14191f" });
    look.font = { ...look.font, color: "#e6eaef" };
    // without a colour of their own they are as dark as the page
    for (const trace of data)
      for (const bars of [trace.error_x, trace.error_y])
        if (bars && !bars.color) bars.color = "#e6eaef";
    for (const [key, inner] of Object.entries(look)) if (axes.test(key)) Object.assign(inner, axis);
    return { data, layout };
  }

  const charts = [];
  for (const data of document.querySelectorAll("script[data-chart]")) {
    const place = document.getElementById(data.dataset.chart);
    if (typeof Plotly === "undefined") {
      place.textContent = "The chart needs the file plotly-….min.js of the folder of reports: copy that along, too.";
      place.style.height = "auto";
      continue;
    }
    charts.push({ place, text: data.textContent, height: parseFloat(place.style.height), drawn: false });
  }

  // heights of a line, and of a name beside its symbol [px]
  const line = 19;
  const entry = 21;
  // what stands beside the text of a name, and beside the plot [px]
  const around = { entry: 44, plot: 110 };
  const sizes = { tick: 14, legend: 14, title: 17 };
  const pen = document.createElement("canvas").getContext("2d");

  // pixels; without a canvas, about as wide as letters are
  function breadth(text, size) {
    const plain = text.replace(/<[^>]*>/g, "");
    if (!pen) return 0.55 * size * plain.length;
    pen.font = `${size}px system-ui, "Segoe UI", Arial, sans-serif`;
    return pen.measureText(plain).width;
  }

  function wrapped(text, room, size) {
    const lines = [""];
    for (const word of text.replaceAll("<br>", " ").split(" ")) {
      const longer = lines.at(-1) ? `${lines.at(-1)} ${word}` : word;
      if (lines.at(-1) && breadth(longer, size) > room) lines.push(word);
      else lines[lines.length - 1] = longer;
    }
    return lines.join("<br>");
  }

  function linesOf(text) {
    return text.split("<br>").length;
  }

  // names beside the plot take less than half of it: they go on in further lines
  function fitNames(data, layout, width) {
    const { tickvals, ticktext } = layout.yaxis || {};
    const names = ticktext || [...new Set(data.flatMap((one) => (Array.isArray(one.y) ? one.y : [])))];
    const room = 0.4 * width;
    if (!names.some((name) => typeof name === "string" && isNaN(name))) return 0;
    if (!names.some((name) => breadth(String(name), sizes.tick) > room)) return 0;
    const short = names.map((name) => wrapped(String(name), room, sizes.tick));
    layout.yaxis = { ...layout.yaxis, tickmode: "array", tickvals: tickvals || names, ticktext: short };
    if (!ticktext) layout.yaxis.type = "category";
    return line * names.length * Math.max(...short.map(linesOf));
  }

  // names and titles that are wider than the chart go on in a further line, for which it grows
  function fit(data, layout, width, height) {
    const room = width - around.plot;
    let more = Math.max(0, fitNames(data, layout, width) - (height - around.plot));
    const titles = [0];
    for (const [key, of] of Object.entries(layout)) {
      if (!/^xaxis/.test(key) || !of.title?.text) continue;
      of.title.text = wrapped(of.title.text, room, sizes.title);
      titles.push(line * (linesOf(of.title.text) - 1));
    }
    more += Math.max(...titles);
    const named = inLegend(data, layout);
    if (named.length > 1) {
      for (const one of named) one.name = wrapped(String(one.name), width - 30 - around.entry, sizes.legend);
      const lines = named.map((one) => one.name.split("<br>"));
      const longest = Math.max(...lines.flat().map((text) => breadth(text, sizes.legend)));
      const columns = Math.max(1, Math.floor(room / (longest + around.entry)));
      const deepest = Math.max(...lines.map((of) => of.length));
      const rows = columns > 1 ? Math.ceil(named.length / columns) * deepest : lines.flat().length;
      // three lines have their place in every chart
      more += entry * Math.max(0, rows - 3);
      // otherwise it is cut off at half of the chart; in one column it is highest
      layout.legend = { ...layout.legend, maxheight: entry * (lines.flat().length + 2) };
    }
    return height + more;
  }

  function inLegend(data, layout) {
    return layout.showlegend === false ? [] : data.filter((one) => one.name && one.showlegend !== false);
  }

  const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
  const axisOf = (full, name, kind) => full[name ? name.replace(kind, `${kind}axis`) : `${kind}axis`];

  // curves that are few are named beside their ends, not in a legend: what each says, or null where
  // that has no room, or where points have no end
  function namesOfEnds(data, layout, width) {
    const named = inLegend(data, layout);
    const sides = Object.entries(layout).some(([key, axis]) => /^yaxis/.test(key) && axis.side === "right");
    if (width < 560 || named.length < 2 || named.length > 4 || sides || layout.polar) return null;
    const isCurve = ({ type = "scatter", mode = "lines", x, y }) =>
      type === "scatter" && mode.includes("lines") && Array.isArray(x) && Array.isArray(y) && y.some((value, k) => isNumber(value) && isNumber(x[k]));
    if (!named.every(isCurve)) return null;
    const texts = named.map((one) => wrapped(String(one.name), 0.24 * width, sizes.legend));
    if (texts.some((text) => linesOf(text) > 3)) return null;
    const room = Math.max(...texts.flatMap((text) => text.split("<br>")).map((text) => breadth(text, sizes.legend)));
    return room > 0.3 * width ? null : { named, texts, room: room + 36 };
  }

  // where two would overprint they are pushed apart
  function labelsOfEnds(place, { named, texts }) {
    const full = place._fullLayout;
    const { t: top, h: high } = full._size;
    const labels = named.map((one, k) => {
      const [across, up] = [axisOf(full, one.xaxis, "x"), axisOf(full, one.yaxis, "y")];
      const points = one.x.map((x, n) => [across.d2p(x), up.d2p(one.y[n])]).filter((point) => point.every(isNumber));
      const within = points.filter(([x]) => x <= across._length + 1);
      const [, y] = (within.length ? within : points).reduce((last, point) => (point[0] >= last[0] ? point : last), [-Infinity, 0]);
      const at = up._offset + Math.max(0, Math.min(up._length, y));
      return { at, text: texts[k], height: 18 * linesOf(texts[k]), colour: one.line?.color, dashed: one.line?.dash && one.line.dash !== "solid" };
    });
    labels.sort((a, b) => a.at - b.at);
    const apart = (a, b) => (a.height + b.height) / 2;
    labels.forEach((label, k) => { if (k) label.at = Math.max(label.at, labels[k - 1].at + apart(label, labels[k - 1])); });
    for (let k = labels.length - 1, limit = top + high; k >= 0; k--) {
      labels[k].at = Math.min(labels[k].at, limit - labels[k].height / 2);
      limit = labels[k].at - labels[k].height / 2;
    }
    return labels.map(({ at, text, colour, dashed }) => ({
      xref: "paper", x: 1, xanchor: "left", xshift: 4, yref: "paper", y: 1 - (at - top) / high, yanchor: "middle", align: "left", showarrow: false,
      font: { size: sizes.legend }, text: `<span style="color:${colour}">${dashed ? "┅" : "━"}</span> ${text.replaceAll("<br>", "<br>\u2003 ")}`,
    }));
  }

  // a picture that leaves the page takes its title and its source along
  function savePicture(plot) {
    const { width, height, _size: size } = plot._fullLayout;
    const title = wrapped(plot.closest("figure").querySelector("figcaption").textContent, width - 40, sizes.title);
    const source = wrapped(document.title, width - 40, 12);
    const [above, below] = [22 * linesOf(title) + 14, 18 * linesOf(source) + 8];
    const layout = structuredClone(plot.layout);
    layout.title = { text: title, font: { size: sizes.title }, x: 0.02, xanchor: "left", yref: "container", y: 1, yanchor: "top", pad: { t: 10 } };
    layout.margin = { l: size.l, r: size.r, t: size.t + above, b: size.b + below };
    const note = { xref: "paper", x: 0, xanchor: "left", yref: "paper", y: 0, yanchor: "bottom", yshift: 4 - size.b - below, text: source, align: "left", showarrow: false, font: { size: 12 } };
    layout.annotations = [...(layout.annotations ?? []), note];
    const sizeOfPicture = { width, height: height + above + below };
    Object.assign(layout, sizeOfPicture, { autosize: false });
    Plotly.downloadImage({ data: plot.data, layout }, { format: "png", scale: 2, filename: plot.id, ...sizeOfPicture });
  }

  // what Plotly has drawn is measured: a title is centred on the plot, which names beside it may
  // have pushed far to one side
  function shortenTitles(place, layout) {
    const frame = place.getBoundingClientRect();
    let more = 0;
    for (const [key, of] of Object.entries(layout)) {
      const drawn = /^[xy]axis/.test(key) && place.querySelector(`.g-${key.replace("axis", "")}title text`);
      if (!drawn || !of.title?.text) continue;
      const at = drawn.getBoundingClientRect();
      const across = key.startsWith("x");
      const [low, high] = across ? [at.left - frame.left, frame.right - at.right] : [at.top - frame.top, frame.bottom - at.bottom];
      if (Math.min(low, high) >= 0) continue;
      const room = (across ? at.width : at.height) + 2 * Math.min(low, high) - 4;
      const text = wrapped(of.title.text, room, sizes.title);
      if (text === of.title.text) continue;
      if (across) more = Math.max(more, line * (linesOf(text) - linesOf(of.title.text)));
      of.title.text = text;
      more = Math.max(more, 1);
    }
    return more;
  }

  // parallel labels meet where neither along nor across their lines there is room between them
  function meet(one, other) {
    const angle = one.angle * Math.PI / 180;
    const apart = [other.x - one.x, other.y - one.y];
    const along = Math.abs(apart[0] * Math.cos(angle) + apart[1] * Math.sin(angle));
    const across = Math.abs(apart[1] * Math.cos(angle) - apart[0] * Math.sin(angle));
    return along < (one.width + other.width) / 2 + 4 && across < 0.8 * Math.min(one.height, other.height);
  }

  // of labels that would overprint only each second, third, ... is shown, of a logarithmic axis
  // first those of 1, 2 and 5, then of 1; names are all shown
  function thin(place) {
    for (const [key, axis] of Object.entries(place._fullLayout)) {
      if (!/^[xy]axis/.test(key) || axis.type === "category" || axis.type === "multicategory") continue;
      const texts = Array.from(place.querySelectorAll(`g.${axis._id}tick text`));
      for (const text of texts) text.style.display = "";
      const labels = texts.map((text) => {
        const box = text.getBBox();
        const at = text.getBoundingClientRect();
        const [, angle] = /rotate\(([-\d.]+)/.exec(text.getAttribute("transform") || "") || [0, 0];
        return { text, angle: Number(angle), width: box.width, height: box.height,
          x: (at.left + at.right) / 2, y: (at.top + at.bottom) / 2, leading: leading(text) };
      }).filter((label) => label.width > 0);
      labels.sort((a, b) => (key.startsWith("x") ? a.x - b.x : a.y - b.y));
      const ways = axis.type === "log" ? [[1, 2, 5], [1, 5], [1]].map((kept) => (label) => kept.includes(label.leading)) : [];
      for (let step = 2; step < labels.length; step++) {
        ways.push((label, k) => k % step === 0);
      }
      let shown = labels;
      const clash = () => shown.some((label, k) => k > 0 && meet(shown[k - 1], label));
      while (clash() && ways.length) {
        const kept = labels.filter(ways.shift());
        if (kept.length > 1) shown = kept;
      }
      for (const label of labels) if (!shown.includes(label)) label.text.style.display = "none";
    }
  }

  // the first digit of a label, where it is the only one that is not zero; 1 of a power of ten
  function leading(text) {
    const number = text.__data__ && text.__data__.x;
    if (typeof number !== "number") return null;
    const digits = (10 ** number).toExponential(3).split("e")[0];
    return Number(digits) >= 9.9995 ? 1 : Number(digits);
  }

  function drawOne({ place, text, height }, paper) {
    const plain = JSON.parse(text);
    const { data, layout } = dark.matches && !paper ? onDark(plain) : plain;
    const width = paper ? 680 : place.clientWidth;
    const ends = namesOfEnds(data, layout, width);
    if (inLegend(data, layout).length === 1) layout.showlegend = false; // the axis says what it is
    if (ends) {
      Object.assign(layout, { showlegend: false, modebar: { orientation: "h" } });
      layout.margin = { ...layout.template.layout.margin, ...layout.margin, r: ends.room };
    }
    const tall = fit(data, layout, width, height);
    for (const [key, axis] of Object.entries(layout)) {
      // fewer are easier to read than turned ones
      if (/^xaxis/.test(key) && axis.type === "log") axis.tickangle ??= 0;
    }
    place.style.height = `${tall}px`;
    // without this a chart keeps the width of the screen on paper, and without a height beside it
    // is drawn 450 pixels high, over what follows it
    if (paper) Object.assign(layout, { width, height: tall, autosize: false });
    Plotly.react(place, data, layout, config).then(() => {
      if (!place.thinned) place.on("plotly_afterplot", () => thin(place));
      place.thinned = true;
      const more = shortenTitles(place, layout);
      if (ends) layout.annotations = [...(layout.annotations ?? []), ...labelsOfEnds(place, ends)];
      if (!more && !ends) return thin(place);
      place.style.height = `${tall + more}px`;
      if (paper) layout.height = tall + more;
      return Plotly.react(place, data, structuredClone(layout), config);
    });
  }

  // one in a fold is drawn when that is opened: there it has a width
  function draw(paper, again) {
    for (const one of charts) {
      const folded = one.place.closest("details:not([open])");
      if (again) one.drawn = false;
      if (one.drawn || (folded && !paper)) continue;
      one.drawn = true;
      drawOne(one, paper);
    }
  }

  draw(false, true);
  document.addEventListener("toggle", () => draw(false, false), true);
  dark.addEventListener("change", () => draw(false, true));
  window.addEventListener("beforeprint", () => draw(true, true));
  window.addEventListener("afterprint", () => draw(false, true));
})();
