// Tables that sort by a click on a column's head and show the rows that have all words of a filter.
(() => {
  'use strict';

  const text = (row, column) => row.cells[column].textContent.trim();

  // The first number of a cell; a true minus sign counts as one.
  const number = (cell) => parseFloat(cell.replace(/\u2212/g, '-').replace(/^[^-\d.]+/, ''));

  const sort = (table, column) => {
    const head = table.tHead.rows[0].cells[column];
    const upwards = head.getAttribute('aria-sort') !== 'ascending';
    for (const other of table.tHead.rows[0].cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', upwards ? 'ascending' : 'descending');
    const numeric = head.classList.contains('number');
    const rows = [...table.tBodies[0].rows].map((row) => {
      const cell = text(row, column);
      return {row, key: numeric ? number(cell) : cell};
    });
    const empty = (key) => key === '' || Number.isNaN(key);
    const compare = (a, b) => numeric ? a - b : a.localeCompare(b, 'en', {numeric: true});
    rows.sort((a, b) => empty(a.key) - empty(b.key) ||  // what has no value comes last
                        (empty(a.key) ? 0 : compare(a.key, b.key) * (upwards ? 1 : -1)));
    table.tBodies[0].append(...rows.map((entry) => entry.row));
  };

  const addFilter = (box, table) => {
    const line = document.createElement('div');
    line.className = 'filter';
    const input = document.createElement('input');
    input.type = 'search';
    input.placeholder = 'filter: words that a row must have';
    input.setAttribute('aria-label', input.placeholder);
    const count = document.createElement('output');
    const rows = [...table.tBodies[0].rows];
    const all = rows.map((row) => row.textContent.toLowerCase());
    const show = () => {
      const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      rows.forEach((row, i) => {
        row.hidden = !words.every((word) => all[i].includes(word));
        shown += row.hidden ? 0 : 1;
      });
      count.textContent = shown + ' of ' + rows.length + ' rows';
    };
    input.addEventListener('input', show);
    line.append(input, count);
    box.before(line);
    show();
  };

  document.querySelectorAll('.table.sortable').forEach((box) => {
    const table = box.querySelector('table');
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      head.tabIndex = 0;
      head.title = 'sort';
      head.addEventListener('click', () => sort(table, column));
      head.addEventListener('keydown', (event) => {
        if (event.key === 'Enter') sort(table, column);
      });
    });
    for (const row of table.tBodies[0].rows) {
      for (const cell of row.cells) cell.title = cell.textContent;  // which may be cut
    }
    addFilter(box, table);
  });
})();
