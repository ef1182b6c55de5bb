// A table that is sorted by a click on a title. A column has a title (text or parts), value(row), by which rows are sorted,
// shown(row), by default the value, and the flags text (for words), wrap, and minor (left out in a narrow window).
class SortedTable {
  // The column by which a table of that name was last sorted, which applies again when it is built anew.
  static sorted = new Map();

  // `onPick(row)` is called when a row is chosen, by its first cell.
  constructor(host, columns, rows, { caption = '', onPick = null, name = 'table', csv = null } = {}) {
    Object.assign(this, { columns, rows, onPick, name, by: null, descending: false });
    this.lines = rows.map((row) => this.line(row));
    this.head = Page.element('tr', {}, ...columns.map((column, i) => this.title(column, i)));
    this.body = Page.element('tbody', {}, ...this.lines);
    const table = Page.element('table', {}, Page.element('thead', {}, this.head), this.body);
    host.append(Page.element('div', { className: 'wide' }, table));
    if (caption) host.append(Page.paragraph(caption, 'faint'));
    if (SortedTable.sorted.has(name)) this.sort(...SortedTable.sorted.get(name));
    if (csv) host.append(Saving.links(Saving.link('CSV', `${name}.csv`, 'text/csv', Saving.csv(csv))));
  }

  static cell(name, column) {
    const styles = { text: column.text, words: column.wrap, minor: column.minor };
    return Page.element(name, { className: Object.keys(styles).filter((style) => styles[style]).join(' ') });
  }

  static button(content, onClick = null) {
    return Page.fill(Page.element('button', { type: 'button', onclick: onClick }), content);
  }

  title(column, i) {
    const cell = Object.assign(SortedTable.cell('th', column), { scope: 'col' });
    cell.append(SortedTable.button(column.title, () => this.sortBy(i)));
    return cell;
  }

  line(row) {
    const line = Page.element('tr', { onclick: this.onPick && (() => this.onPick(row)) });
    this.columns.forEach((column, i) => {
      const cell = SortedTable.cell('td', column),
        content = column.shown ? column.shown(row) : String(column.value(row));
      if (i === 0 && this.onPick) cell.append(SortedTable.button(content));
      else Page.fill(cell, content);
      line.append(cell);
    });
    return line;
  }

  sortBy(i) {
    SortedTable.sorted.set(this.name, [i, this.by === i && !this.descending]);
    this.sort(...SortedTable.sorted.get(this.name));
  }

  // Sorts numbers before words; values that do not exist come last in both directions.
  sort(i, descending) {
    Object.assign(this, { by: i, descending });
    if (!this.columns[i]) return;
    const turn = descending ? -1 : 1,
      missing = (value) => value === null || value === undefined || Number.isNaN(value);
    const compared = (a, b) => {
      if (missing(a) || missing(b)) return missing(a) - missing(b);
      if (typeof a === 'number' && typeof b === 'number') return turn * (a - b);
      return turn * String(a).localeCompare(String(b), 'en', { numeric: true });
    };
    const order = this.rows
      .map((row, place) => ({ place, value: this.columns[i].value(row) }))
      .sort((a, b) => compared(a.value, b.value) || a.place - b.place);
    this.body.replaceChildren(...order.map(({ place }) => this.lines[place]));
    SortedTable.mark([...this.head.cells], i, 'aria-sort', descending ? 'descending' : 'ascending');
  }

  choose(index) {
    SortedTable.mark(this.lines, index, 'aria-selected', 'true');
  }

  // Gives the attribute to the element at `place` and to no other.
  static mark(elements, place, name, value) {
    for (const element of elements) element.removeAttribute(name);
    if (elements[place]) elements[place].setAttribute(name, value);
  }
}
