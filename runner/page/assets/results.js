// The table of the points.
function resultsShown(data) {
  return [
    data.target,
    data.parameters,
    data.quantities,
    data.points.map((point) => [
      point.label,
      point.standing,
      point.marks,
      point.seeds.wanted,
      point.seeds.wanted_ended,
      point.seeds.looked_at,
      point.losses,
      point.endings,
      point.cpu_seconds,
    ]),
  ];
}

function resultsTable(data, sweep, host, onPick) {
  const { target } = data,
    path = target.observable.replace(/^\//, '');
  const column = data.quantities.findIndex((quantity) => quantity.path === path);
  const about =
    column < 0 ? { words: Format.words(path), symbol: [], unit: '' } : Format.quantity(data.quantities[column]);
  const isKnown = (point) => column >= 0 && Sweep.isKnown(point, point.estimates[column]);
  const numbers = (point) => (isKnown(point) ? point.estimates[column] : [null, null, null, 0]);
  const plain = (point) => point.uncontrolled[path] || numbers(point);  // the same without a control variate
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
        if (row.point.endings.has_jammed && !isKnown(row.point)) return 'jammed';
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
  columns.push(
    { title: 'lost', minor: true, cell: (row) => String(lost(row)), sort: lost },
    { title: 'verdict', text: true, cell: (row) => row.point.standing, sort: (row) => row.point.standing },
  );
  if (data.points.some((point) => point.marks.length)) {
    columns.push({
      title: 'marks',
      text: true,
      wrap: true,
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
        plain(row.point)[0],
        plain(row.point)[2],
        lost(row),
        row.point.cpu_seconds,
      ]),
    },
  });
}
