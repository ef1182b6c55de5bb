// The page: its data and its parts.
const Page = {
  // Text, or parts of Format.symbol(), into an element.
  fill(element, content) {
    for (const part of Array.isArray(content) ? content : [{ text: content, level: 0 }]) {
      const inner = part.level ? document.createElement(part.level > 0 ? 'sup' : 'sub') : null;
      if (inner) inner.textContent = part.text;
      element.append(inner || part.text);
    }
    return element;
  },
  heading(level, text) {
    return Page.fill(document.createElement(level), text);
  },
  paragraph(text, style = '') {
    const made = Page.fill(document.createElement('p'), text);
    if (style) made.className = style;
    return made;
  },
  details(title, open = false) {
    const details = document.createElement('details');
    details.open = open;
    details.append(Page.fill(document.createElement('summary'), title));
    return details;
  },
  labelled(text, control) {
    const label = document.createElement('label');
    label.append(text, control);
    return label;
  },
  // options: [[value, text, group]], in the order of their groups.
  select(options, onChange) {
    const select = document.createElement('select');
    let place = select;
    for (const [value, text, group] of options) {
      if (group && place.label !== group) {
        place = document.createElement('optgroup');
        place.label = group;
        select.append(place);
      }
      place.append(new Option(text, value));
    }
    select.addEventListener('change', onChange);
    return select;
  },
  list(items) {
    const list = document.createElement('dl');
    for (const [term, meaning] of items)
      list.append(Page.fill(document.createElement('dt'), term), Page.fill(document.createElement('dd'), meaning));
    return list;
  },
  group(name, value) {
    const [words, symbol] = Format.groups[name] || [Format.words(name), ''];
    return `${words}${symbol ? ` ${symbol}` : ''} ${Format.rough(value)}`;
  },
};

// One line that says how the campaign stands.
function headline({ progress }) {
  const parts = [`${progress.decided} of ${Format.counted(progress.points, 'point')} decided`];
  const others = Object.entries(progress.standings).filter(([name]) => name !== 'converged' && name !== 'open');
  if (others.length) parts[0] += ` (${others.map(([name, count]) => `${count} ${name}`).join(', ')})`;
  const ahead = progress.cpu_seconds_to_go;
  let time = `${Format.duration(progress.cpu_seconds)} of processor time spent`;
  if (ahead && ahead.likely > 0)
    time += `, ${Format.duration(ahead.likely)} to go (${[ahead.low, ahead.high].map(Format.duration).join(' to ')})`;
  else if (ahead) time += ', none to go';
  parts.push(time);
  if (progress.owner !== null) parts.push(`${Format.counted(progress.workers, 'worker')} busy`);
  else if (ahead && ahead.likely > 0) parts.push('nobody runs it now');
  if (progress.seeds.handed_over) parts.push(`${Format.counted(progress.seeds.handed_over, 'seed')} handed over`);
  return parts.join(' · ');
}

// The chart over the sweep and what is chosen for it.
class SweepView {
  constructor(data, host, onPick) {
    this.sweep = new Sweep(data);
    this.choices = this.sweep.choices();
    this.data = data;
    const { sweep } = this,
      option = (one, i) => [String(i), Format.option(one.about)];
    this.quantity = Page.select(
      this.choices.map((one, i) => [...option(one, i), one.group]),
      () => this.renew(),
    );
    this.axis = Page.select(sweep.parameters.map(option), () => this.renew());
    this.panels = Page.select([['usual', 'as fits'], ['none', 'none'], ...sweep.parameters.map(option)], () =>
      this.draw(),
    );
    this.axis.value = String(sweep.parameters.indexOf(sweep.usual));
    [this.logX, this.logY] = [0, 1].map(() => Object.assign(document.createElement('input'), { type: 'checkbox' }));
    this.logX.id = 'log-x';
    this.logY.id = 'log-y';
    this.quantity.id = 'quantity';
    this.axis.id = 'axis';
    this.panels.id = 'panels';
    for (const box of [this.logX, this.logY])
      box.addEventListener('change', () => {
        this.setByHand = true;
        this.draw();
      });
    const controls = document.createElement('div');
    controls.className = 'controls';
    const switched = (text, box) => {
      const label = Page.labelled('', box);
      label.className = 'switch';
      label.append(text);
      return label;
    };
    const scales = document.createElement('span');
    scales.append(switched('log x', this.logX), switched('log y', this.logY));
    controls.append(
      Page.labelled('Quantity', this.quantity),
      Page.labelled('Over', this.axis),
      Page.labelled('Panels', this.panels),
      scales,
    );
    this.chart = new Chart(document.createElement('figure'), onPick);
    host.append(Page.heading('h2', 'Results'), controls, this.chart.host);
    this.renew();
  }

  // Another quantity or axis: scales are again those that fit.
  renew() {
    this.setByHand = false;
    this.draw();
  }

  draw() {
    const { sweep } = this,
      choice = this.choices[Number(this.quantity.value)],
      axis = sweep.parameters[Number(this.axis.value)];
    const usual = sweep.usualPanels(axis, choice ? choice.indices.length : 1),
      chosen = this.panels.value;
    const by =
      chosen === 'usual'
        ? usual
        : chosen === 'none'
          ? []
          : [sweep.parameters[Number(chosen)]].filter((one) => one !== axis);
    if (!choice) {
      this.chart.show({ panels: [] });
      return;
    }
    const figure = sweep.figure(
      choice,
      axis,
      by,
      this.setByHand ? { x: this.logX.checked, y: this.logY.checked } : {},
    );
    this.logX.checked = figure.x.log;
    this.logY.checked = figure.y.log;
    this.logX.disabled = !axis.numeric;
    const confidence = Format.rough(100 * this.data.target.confidence);
    figure.caption = `Bars are ${confidence} % intervals; lines only guide the eye.${
      figure.hasBand ? ' Bands: the tolerance around each mean.' : ''
    }${
      figure.kinds.includes('provisional')
        ? ' Provisional: the point is not decided yet, and its number may still change.'
        : ''
    }`;
    this.chart.show(figure);
  }
}

function resultsTable(data, sweep, host, onPick) {
  const { target } = data,
    path = target.observable.replace(/^\//, '');
  const column = data.quantities.findIndex((quantity) => quantity.path === path);
  const about =
    column < 0 ? { words: Format.words(path), symbol: [], unit: '' } : Format.quantity(data.quantities[column]);
  const numbers = (point) => (column < 0 ? null : point.estimates[column]) || [null, null, null, 0];
  const plain = (point) => point.uncontrolled[path] || null;
  const rows = data.points.map((point, i) => ({ point, i })),
    relative = target.relative_tolerance !== undefined;
  const measure = (row) => {
    const [mean, , half] = numbers(row.point);
    return !Format.isNumber(half) ? null : relative && !target.relative_to ? half / Math.abs(mean) : half;
  };
  const lost = (row) => Object.values(row.point.losses).reduce((sum, count) => sum + count, 0);
  const columns = sweep.parameters.map((one) => ({
    title: one.about.symbol.length ? one.about.symbol : one.about.words,
    text: !one.numeric,
    cell: (row) => (one.numeric ? Format.plain(one.cells[row.i]) : String(one.cells[row.i])),
    sort: (row) => one.cells[row.i],
  }));
  columns.push(
    {
      title: 'seeds',
      minor: true,
      cell: (row) => `${row.point.seeds.wanted_ended}/${row.point.seeds.wanted}`,
      sort: (row) => row.point.seeds.wanted,
    },
    {
      title: about.symbol.length ? about.symbol : about.words,
      cell: (row) => {
        const [mean, , half] = numbers(row.point);
        return Format.withError(mean, half) + (row.point.decided || !Format.isNumber(mean) ? '' : ' *');
      },
      sort: (row) => numbers(row.point)[0],
    },
    {
      title: relative && !target.relative_to ? 'relative' : 'half-width',
      minor: true,
      cell: (row) => (relative && !target.relative_to ? Format.percent(measure(row)) : Format.rough(measure(row))),
      sort: measure,
    },
  );
  if (data.points.some((point) => plain(point) && plain(point)[0] !== numbers(point)[0])) {
    columns.push({
      title: 'uncontrolled',
      minor: true,
      cell: (row) => (plain(row.point) ? Format.withError(plain(row.point)[0], plain(row.point)[2]) : ''),
      sort: (row) => (plain(row.point) ? plain(row.point)[0] : null),
    });
  }
  columns.push(
    { title: 'lost', minor: true, cell: (row) => String(lost(row)), sort: lost },
    { title: 'verdict', text: true, cell: (row) => row.point.standing, sort: (row) => row.point.standing },
  );
  if (data.points.some((point) => point.marks.length)) {
    columns.push({
      title: 'marks',
      text: true,
      wrap: true,
      minor: true,
      cell: (row) => row.point.marks.join(', '),
      sort: (row) => row.point.marks.join(', '),
    });
  }
  const open = data.points.some((point) => !point.decided);
  return new SortedTable(host, columns, rows, {
    onPick: (row) => onPick(row.i),
    name: `${data.campaign} results`,
    caption: `Seeds: those that have ended, of those that the deciding look takes (of an open point, the next look). ${
      about.words
    }: the mean, with the control variate where there is one, ± the half-width of its ${Format.rough(
      100 * target.confidence,
    )} % interval.${open ? ' *: provisional.' : ''}`,
    csv: {
      columns: [
        'label',
        'hash',
        ...data.parameters.map((one) => one.pointer),
        'verdict',
        'seeds',
        'count',
        'mean',
        'standard_error',
        'half_width',
        'uncontrolled_mean',
        'uncontrolled_half_width',
        'lost',
        'cpu_seconds',
      ],
      rows: rows.map((row) => [
        row.point.label,
        row.point.hash,
        ...data.parameters.map((one) => row.point.settings[one.pointer]),
        row.point.standing,
        row.point.seeds.looked_at,
        numbers(row.point)[3],
        ...numbers(row.point).slice(0, 3),
        plain(row.point) ? plain(row.point)[0] : null,
        plain(row.point) ? plain(row.point)[2] : null,
        lost(row),
        row.point.cpu_seconds,
      ]),
    },
  });
}
