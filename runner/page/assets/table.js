// A table that sorts by a click on a title. columns: [{title: parts or text, text: whether words, minor: left out where
// it is narrow, wrap, cell(row), sort(row)}].
class SortedTable {
  // By which column a table of that name was sorted last, so that it stays so when it is made anew.
  static sorted = new Map();

  // `onPick(row)`: a row was chosen, by its first cell.
  constructor(host, columns, rows, { caption = '', onPick = null, name = 'table', csv = null } = {}) {
    Object.assign(this, { columns, rows, onPick, chosen: null, by: null, descending: false });
    const wide = document.createElement('div');
    wide.className = 'wide';
    this.table = document.createElement('table');
    const head = document.createElement('thead'),
      line = document.createElement('tr');
    columns.forEach((column, i) => {
      const th = document.createElement('th'),
        button = document.createElement('button');
      th.className = SortedTable.style(column);
      th.scope = 'col';
      button.type = 'button';
      Page.fill(button, column.title);
      button.addEventListener('click', () => this.sortBy(i));
      th.append(button);
      line.append(th);
    });
    head.append(line);
    this.body = document.createElement('tbody');
    this.lines = rows.map((row) => this.line(row));
    this.body.append(...this.lines);
    this.table.append(head, this.body);
    wide.append(this.table);
    host.append(wide);
    if (caption) host.append(Page.paragraph(caption, 'faint'));
    this.name = name;
    if (SortedTable.sorted.has(name)) this.sort(...SortedTable.sorted.get(name));
    if (csv) host.append(Saving.links(Saving.link('CSV', `${name}.csv`, 'text/csv', Saving.csv(csv))));
  }

  static style(column) {
    return [column.text ? 'text' : '', column.wrap ? 'words' : '', column.minor ? 'minor' : '']
      .filter(Boolean)
      .join(' ');
  }

  line(row) {
    const line = document.createElement('tr');
    this.columns.forEach((column, i) => {
      const cell = document.createElement('td');
      cell.className = SortedTable.style(column);
      if (i === 0 && this.onPick) {
        const button = document.createElement('button');
        button.type = 'button';
        Page.fill(button, column.cell(row));
        cell.append(button);
      } else {
        Page.fill(cell, column.cell(row));
      }
      line.append(cell);
    });
    if (this.onPick) line.addEventListener('click', () => this.onPick(row));
    return line;
  }

  sortBy(i) {
    this.descending = this.by === i && !this.descending;
    this.by = i;
    SortedTable.sorted.set(this.name, [i, this.descending]);
    this.sort(i, this.descending);
  }

  // Numbers before words; what does not exist comes last either way.
  sort(i, descending) {
    Object.assign(this, { by: i, descending });
    if (!this.columns[i]) return;
    const { sort } = this.columns[i],
      turn = this.descending ? -1 : 1;
    const missing = (value) => value === null || value === undefined || Number.isNaN(value);
    const order = this.rows
      .map((row, place) => ({ place, value: sort(row) }))
      .sort((a, b) => {
        if (missing(a.value) || missing(b.value)) return missing(a.value) - missing(b.value) || a.place - b.place;
        if (typeof a.value === 'number' && typeof b.value === 'number')
          return turn * (a.value - b.value) || a.place - b.place;
        return turn * String(a.value).localeCompare(String(b.value), 'en', { numeric: true }) || a.place - b.place;
      });
    this.body.replaceChildren(...order.map(({ place }) => this.lines[place]));
    [...this.table.tHead.rows[0].cells].forEach((cell, place) => {
      if (place === i) cell.setAttribute('aria-sort', this.descending ? 'descending' : 'ascending');
      else cell.removeAttribute('aria-sort');
    });
  }

  choose(index) {
    this.rows.forEach((_, i) => {
      if (i === index) this.lines[i].setAttribute('aria-selected', 'true');
      else this.lines[i].removeAttribute('aria-selected');
    });
  }
}
