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
    modeBarButtonsToRemove: ["lasso2d", "select2d", "sendChartToCloud"],
  };
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
    charts.push({ place, text: data.textContent, height: place.clientHeight });
  }

  // about as wide as letters are [px], high as lines are, and wide as what stands round them is
  const letter = { legend: 7, title: 8 };
  const line = 19;
  const around = { entry: 44, plot: 110 };

  function plainText(text) {
    return text.replace(/<[^>]*>/g, "");
  }

  function wrapped(text, most) {
    const lines = [""];
    for (const word of text.split(" ")) {
      const longer = lines.at(-1) ? `${lines.at(-1)} ${word}` : word;
      if (lines.at(-1) && plainText(longer).length > most) lines.push(word);
      else lines[lines.length - 1] = longer;
    }
    return lines.join("<br>");
  }

  // names and titles that are wider than the chart go on in a further line, for which it grows
  function fit(data, layout, width, height) {
    const room = width - around.plot;
    let more = 0;
    for (const [key, of] of Object.entries(layout)) {
      if (!/^xaxis/.test(key) || !of.title?.text) continue;
      of.title.text = wrapped(of.title.text, room / letter.title);
      more = Math.max(more, line * (of.title.text.split("<br>").length - 1));
    }
    const named = data.filter((one) => one.name && one.showlegend !== false);
    if (layout.showlegend !== false && named.length > 1) {
      for (const one of named) one.name = wrapped(String(one.name), (width - 20 - around.entry) / letter.legend);
      const lines = named.map((one) => one.name.split("<br>"));
      const longest = Math.max(...lines.flat().map((text) => plainText(text).length));
      const columns = Math.max(1, Math.floor(room / (longest * letter.legend + around.entry)));
      const deepest = Math.max(...lines.map((of) => of.length));
      const rows = columns > 1 ? Math.ceil(named.length / columns) * deepest : lines.flat().length;
      // three lines have their place in every chart
      more += line * Math.max(0, rows - 3);
      // otherwise it is cut off at half of the chart
      if (rows > 3) layout.legend = { ...layout.legend, maxheight: line * (rows + 2) };
    }
    return height + more;
  }

  // half as many decades have labels where there is little room, and parts of them 1, 2 and 5
  function spare(axis, data) {
    const values = data.flatMap((one) => one.x || []).filter((x) => x > 0);
    if (typeof axis.dtick === "number") axis.dtick *= 2;
    else if (Math.max(...values) / Math.min(...values) < 3) axis.tickangle = -90;
    else if (axis.tickvals) {
      const kept = axis.tickvals.map((x) => [1, 2, 5].includes(Number(x.toExponential()[0])));
      axis.ticktext = axis.ticktext.map((text, k) => (kept[k] ? text : ""));
    } else axis.dtick = "D2";
  }

  function draw(paper) {
    for (const { place, text, height } of charts) {
      const plain = JSON.parse(text);
      const { data, layout } = dark.matches && !paper ? onDark(plain) : plain;
      const { xaxis } = layout;
      const width = paper ? 680 : place.clientWidth;
      if (width < 500 && xaxis && xaxis.type === "log") {
        spare(xaxis, data);
      }
      place.style.height = `${fit(data, layout, width, height)}px`;
      // without this a chart keeps the width of the screen on paper
      if (paper) Object.assign(layout, { width, autosize: false });
      Plotly.react(place, data, layout, config);
    }
  }

  draw(false);
  dark.addEventListener("change", () => draw(false));
  window.addEventListener("beforeprint", () => draw(true));
  window.addEventListener("afterprint", () => draw(false));
})();
