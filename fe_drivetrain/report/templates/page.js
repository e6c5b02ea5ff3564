"use strict";
// buttons that copy a command, and that save a table with all its digits
(function () {
  document.documentElement.classList.add("scripted");

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
})();
