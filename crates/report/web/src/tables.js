// Tables whose rows a reader sorts by a click, or the enter key, on a heading.

/** What a row is sorted by: the number that a cell stands for, or its words. */
function key(row, column) {
  const cell = row.children[column];
  return cell.dataset.order === undefined ? cell.textContent.trim() : Number(cell.dataset.order);
}

function compare(x, y) {
  // numbers come before words
  if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;
  return typeof x === "number" ? x - y : x.localeCompare(y, "en", { numeric: true });
}

function sort(table, button) {
  const head = button.closest("th");
  const column = [...head.parentNode.children].indexOf(head);
  const ascending = head.getAttribute("aria-sort") !== "ascending";
  for (const other of head.parentNode.children) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const sign = ascending ? 1 : -1;
  const body = table.tBodies[0];
  const rows = [...body.rows].map(row => [key(row, column), row]);
  rows.sort(([x], [y]) => sign * compare(x, y));
  body.append(...rows.map(([, row]) => row));
}

export function makeSortable(table) {
  for (const button of table.querySelectorAll("thead button")) {
    button.addEventListener("click", () => sort(table, button));
  }
}

/** What is wider than its frame says so: its edge fades, and words count the columns of a table. */
export function makeScrollHint(box) {
  const hint = document.createElement("p");
  hint.className = "hint";
  hint.setAttribute("aria-hidden", "true");
  box.before(hint);
  const look = () => {
    const edge = box.getBoundingClientRect().right;
    const heads = [...box.querySelectorAll("thead th")];
    const goesOn = box.scrollLeft + box.clientWidth < box.scrollWidth - 1;
    const beyond = heads.filter(head => head.getBoundingClientRect().right > edge + 1).length;
    box.classList.toggle("more", goesOn && (beyond > 0 || heads.length === 0));
    const columns = beyond === 1 ? "1 more column" : `${beyond} more columns`;
    const what = heads.length > 0 ? columns : "more";
    hint.textContent = box.classList.contains("more") ? `${what} to the right: scroll \u2192` : "";
    hint.hidden = box.scrollWidth <= box.clientWidth + 1;
  };
  box.addEventListener("scroll", look, { passive: true });
  new ResizeObserver(look).observe(box);
  look();
}
