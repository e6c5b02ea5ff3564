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
    charts.push({ place, text: data.textContent });
  }

  function draw(paper) {
    for (const { place, text } of charts) {
      const plain = JSON.parse(text);
      const { data, layout } = dark.matches && !paper ? onDark(plain) : plain;
      // half as many decades have labels where there is little room
      const { xaxis } = layout;
      const narrow = place.clientWidth < 500 && !paper;
      if (narrow && xaxis && xaxis.type === "log" && typeof xaxis.dtick === "number") xaxis.dtick *= 2;
      // without this a chart keeps the width of the screen on paper
      if (paper) Object.assign(layout, { width: 680, autosize: false });
      Plotly.react(place, data, layout, config);
    }
  }

  draw(false);
  dark.addEventListener("change", () => draw(false));
  window.addEventListener("beforeprint", () => draw(true));
  window.addEventListener("afterprint", () => draw(false));
})();
