"use strict";
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
  const charts = [];
  for (const data of document.querySelectorAll("script[data-chart]")) {
    const chart = document.getElementById(data.dataset.chart);
    const figure = JSON.parse(data.textContent);
    Plotly.newPlot(chart, figure.data, figure.layout, config);
    charts.push(chart);
  }
  // without this a chart keeps the width of the screen on paper
  const refit = function (width) {
    for (const chart of charts) {
      Plotly.relayout(chart, width ? { width: width, autosize: false } : { width: null, autosize: true });
    }
  };
  window.addEventListener("beforeprint", function () { refit(680); });
  window.addEventListener("afterprint", function () { refit(0); });
})();
