"use strict";
// buttons that copy and save; links and paper that unfold what is folded
(function () {
  document.documentElement.classList.add("scripted");
  // what a reader of a few printed pages does not ask for is left out
  if (location.hash === "#brief") document.documentElement.classList.add("brief");

  function copied(button) {
    const text = button.textContent;
    button.textContent = "copied";
    setTimeout(function () { button.textContent = text; }, 1500);
  }

  function copy(button) {
    const source = document.getElementById(button.dataset.copies);
    const select = function () {
      // where the clipboard is not open to pages of the file system
      const range = document.createRange();
      range.selectNodeContents(source);
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      if (document.execCommand("copy")) copied(button);
    };
    if (!navigator.clipboard) return select();
    navigator.clipboard.writeText(source.textContent).then(() => copied(button), select);
  }

  function saved(table) {
    const cell = function (element) {
      let text = element.dataset.value ?? element.textContent.trim();
      // as text, or a spreadsheet would take it for a formula
      if (/^[=+\-@\t\r]/.test(text) && isNaN(text)) text = `'${text}`;
      return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
    };
    const lines = Array.from(table.rows, (row) => Array.from(row.cells, cell).join(","));
    return lines.join("\r\n") + "\r\n";
  }

  function save(button) {
    const table = document.getElementById(button.dataset.saves);
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob(["\ufeff" + saved(table)], { type: "text/csv" }));
    link.download = `${table.id}.csv`;
    link.click();
    setTimeout(function () { URL.revokeObjectURL(link.href); }, 1000);
  }

  for (const button of document.querySelectorAll("button[data-copies]")) {
    button.addEventListener("click", () => copy(button));
  }
  for (const button of document.querySelectorAll("button[data-saves]")) {
    button.addEventListener("click", () => save(button));
  }

  function unfold(hash) {
    const at = document.getElementById(decodeURIComponent(hash.slice(1)));
    if (!at) return;
    const own = at.querySelector(":scope > details");
    if (own) own.open = true;
    for (let of = at; of; of = of.parentElement) if (of.tagName === "DETAILS") of.open = true;
    at.scrollIntoView();
  }

  // also of a link to where the page is already, which its reader has folded since
  document.addEventListener("click", function (event) {
    const link = event.target.closest("a[href^='#']");
    if (link) setTimeout(() => unfold(link.hash));
  });
  window.addEventListener("hashchange", () => unfold(location.hash));
  if (location.hash) unfold(location.hash);

  for (const button of document.querySelectorAll("button[data-unfolds]")) {
    button.addEventListener("click", function () {
      const folds = Array.from(document.querySelectorAll(".fold > details"));
      const open = folds.some((of) => !of.open);
      for (const of of folds) of.open = open;
      button.textContent = open ? "fold all" : "unfold all";
    });
  }

  let folded = [];
  window.addEventListener("beforeprint", function () {
    folded = Array.from(document.querySelectorAll("details:not([open])"));
    for (const of of folded) of.open = true;
  });
  window.addEventListener("afterprint", function () {
    for (const of of folded) of.open = false;
    folded = [];
  });
})();
