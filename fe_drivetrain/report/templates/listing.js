"use strict";
// search, filters and sorting of the one long table of a page
(function () {
  const table = document.querySelector("table.listing");
  if (!table) return;
  document.documentElement.classList.add("scripted");
  const body = table.tBodies[0];
  const rows = Array.from(body.rows);
  const texts = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));
  const search = document.getElementById("search");
  const group = document.getElementById("group");
  const count = document.getElementById("count");
  const filters = Array.from(document.querySelectorAll("button.filter"));
  const most = 300; // rows at once: a browser lays out thousands slowly
  const more = document.createElement("button");
  let all = false;

  more.type = "button";
  more.className = "more";
  table.after(more);

  function show() {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = {};
    for (const button of filters) {
      if (button.getAttribute("aria-pressed") === "true") {
        (wanted[button.dataset.key] ||= []).push(button.dataset.value);
      }
    }
    let found = 0;
    for (const row of body.rows) {
      const fits =
        words.every((word) => texts.get(row).includes(word)) &&
        Object.entries(wanted).every(([key, values]) => values.includes(row.dataset[key])) &&
        (!group || !group.value || row.dataset.group === group.value);
      found += fits;
      row.hidden = !fits || (!all && found > most);
    }
    const shown = all ? found : Math.min(found, most);
    count.textContent = `${shown} of ${rows.length} ${count.dataset.what}`;
    more.hidden = shown === found;
    more.textContent = `Show ${found - shown} more`;
  }

  function value(row, column) {
    const cell = row.cells[column];
    const text = cell.dataset.value ?? cell.textContent;
    return text === "" || isNaN(text) ? text : Number(text);
  }

  function sort(heading) {
    const down = heading.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", down ? "descending" : "ascending");
    const column = heading.cellIndex;
    const order = function (a, b) {
      const one = value(a, column);
      const other = value(b, column);
      if (one === "" || other === "") return (one === "") - (other === ""); // without a value: last
      const compared =
        typeof one === "number" && typeof other === "number" ? one - other : String(one).localeCompare(String(other));
      return down ? -compared : compared;
    };
    body.append(...Array.from(body.rows).sort(order));
    show();
  }

  for (const heading of table.tHead.rows[0].cells) {
    const button = heading.querySelector("button");
    if (button) button.addEventListener("click", () => sort(heading));
  }
  for (const button of filters) {
    button.addEventListener("click", function () {
      button.setAttribute("aria-pressed", String(button.getAttribute("aria-pressed") !== "true"));
      show();
    });
  }
  search.addEventListener("input", show);
  if (group) group.addEventListener("change", show);
  more.addEventListener("click", function () {
    all = true;
    show();
  });
  show();
})();
