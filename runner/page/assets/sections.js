// The data that each section shows; it is built anew only if they have changed.
const doubtsShown = (data) => [data.points.map((point) => [point.label, point.losses, point.loss_reasons]), data.meanings, data.warnings],
  costShown = (data) => [data.progress.seeds, data.points.map(({ label, seeds, cpu_seconds }) => [label, seeds.ended, seeds.extra, cpu_seconds])],
  resultsShown = (data) => [data.target, data.parameters, data.quantities, data.points.map(resultShown)],
  resultShown = ({ label, state, marks, seeds, losses, endings, cpu_seconds }) =>
    [label, state, marks, seeds.wanted, seeds.wanted_ended, seeds.tested, losses, endings, cpu_seconds],
  originShown = (data) => [data.scene, data.parameters, data.provenance, data.commands, data.document || data.documents, data.points.map((point) => point.groups)];

function resultsTable(data, sweep, host, onPick) {
  const { target } = data,
    { path, column, about } = Sweep.aim(data),
    isShare = target.relative_tolerance !== undefined && !target.relative_to;
  const isKnown = (point) => column >= 0 && Sweep.isKnown(point, point.estimates[column]);
  const numbers = (point) => (isKnown(point) ? point.estimates[column] : [null, null, null, 0]);
  const plain = (point) => point.plain[path] || numbers(point);  // without control variate
  const rows = data.points.map((point, i) => ({ point, i }));
  const measure = (row) => {
    const [mean, , half] = numbers(row.point);
    return !Format.isNumber(half) ? null : isShare ? half / Math.abs(mean) : half;
  };
  const lost = (row) => Object.values(row.point.losses).reduce((sum, count) => sum + count, 0);
  const mean = (row) => {
    const [value, , half] = numbers(row.point);
    if (row.point.endings.has_jammed && !isKnown(row.point)) return 'jammed';
    return Format.withError(value, half) + (row.point.decided || !Format.isNumber(value) ? '' : ' *');
  };
  const columns = [
    ...sweep.parameters.map(({ about: parameter, numeric, cells }) => ({
      title: Format.short(parameter),
      text: !numeric,
      value: (row) => cells[row.i],
      shown: (row) => (numeric ? Format.plain(cells[row.i]) : String(cells[row.i])),
    })),
    {
      title: 'seeds',
      minor: true,
      value: (row) => row.point.seeds.wanted,
      shown: (row) => `${row.point.seeds.wanted_ended}/${row.point.seeds.wanted}`,
    },
    { title: Format.short(about), value: (row) => numbers(row.point)[0], shown: mean },
    {
      title: isShare ? 'relative half-width' : 'half-width',
      minor: true,
      value: measure,
      shown: (row) => (isShare ? Format.percent(measure(row)) : Format.rough(measure(row))),
    },
    { title: 'lost', minor: true, value: lost },
    { title: 'verdict', text: true, value: (row) => row.point.state },
  ];
  if (data.points.some((point) => point.marks.length))
    columns.push({ title: 'marks', text: true, wrap: true, value: (row) => row.point.marks.join(', ') });
  const open = data.points.some((point) => !point.decided);
  return new SortedTable(host, columns, rows, {
    onPick: (row) => onPick(row.i),
    name: `${data.campaign} results`,
    caption:
      'Seeds: the number that have ended / the number that the deciding stop test takes (for an open point, the next one). ' +
      `${about.words}: the mean, with the control variate if there is one, ± the half-width of its ` +
      `${Format.rough(100 * target.confidence)} % interval.${open ? ' *: provisional.' : ''}`,
    csv: {
      columns: ['label', 'hash', ...data.parameters.map((one) => one.pointer), 'verdict', 'seeds', 'count', 'mean',
        'standard_error', 'half_width', 'plain_mean', 'plain_half_width', 'lost', 'cpu_seconds'],
      rows: rows.map((row) => [
        row.point.label,
        row.point.hash,
        ...data.parameters.map((one) => row.point.settings[one.pointer]),
        row.point.state,
        row.point.seeds.tested,
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

// The workers now, and the last attempts as a chart over time.
class WorkView {
  constructor(host) {
    this.now = Page.element('div');
    this.chart = new Chart();
    host.append(Page.heading('h2', 'Workers'), this.now, this.chart.host);
  }

  show(data) {
    Page.renew(this.now, data.work.now, (host) => {
      if (data.work.now.length) WorkView.table(data, host);
    });
    this.chart.show(WorkView.figure(data));
  }

  static table(data, host) {
    const done = (row) => (row.steps > 0 ? row.step / row.steps : null);
    new SortedTable(
      host,
      [
        { title: 'worker', value: (row) => row.worker },
        { title: 'point', text: true, wrap: true, value: (row) => data.points[row.point].label },
        { title: 'seed', value: (row) => row.seed },
        { title: 'phase', text: true, minor: true, value: (row) => row.phase },
        { title: 'done', value: done, shown: (row) => (Format.isNumber(done(row)) ? `${Math.round(100 * done(row))} %` : '–') },
        { title: 'strain', minor: true, value: (row) => row.strain, shown: (row) => Format.rough(row.strain) },
      ],
      data.work.now,
      { name: 'workers' },
    );
  }

  static outcomes = [
    { name: 'result', series: 0 },
    { name: 'running', series: 4 },
    { name: 'no result', series: 1 },
  ];

  // Returns the chart of attempts. Times are those of the owner's clock, to a second.
  static figure(data) {
    const seconds = (text) => Date.parse(text) / 1000,
      { attempts } = data.work;
    const hosts = new Set(attempts.map((one) => one.host)),
      who = (one) => (hosts.size > 1 ? `${one.host.slice(0, 6)}:${one.worker}` : String(one.worker));
    const workers = [...new Set(attempts.map(who))].sort((a, b) => a.localeCompare(b, 'en', { numeric: true }));
    const begin = attempts.reduce((least, one) => Math.min(least, seconds(one.began)), Infinity),
      length = attempts.reduce((most, one) => Math.max(most, seconds(one.ended)), begin) - begin;
    const [unit, size] = length < 180 ? ['s', 1] : length < 3 * 3600 ? ['min', 60] : ['h', 3600];
    const kindOf = (one) => WorkView.outcomes.find(({ name }) => name === one.outcome) || WorkView.outcomes[2];
    const columns = attempts.map((one) => {
      const row = workers.indexOf(who(one)),
        took = seconds(one.ended) - seconds(one.began);
      return {
        from: (seconds(one.began) - begin) / size,
        to: (seconds(one.ended) - begin) / size,
        low: row - 0.35,
        high: row + 0.35,
        series: kindOf(one).series,
        text: `${data.points[one.point].label} seed ${one.seed}, ${one.outcome}, ${Format.duration(took)}`,
      };
    });
    const used = new Set(attempts.map(kindOf));
    return {
      name: `${data.campaign} workers`,
      height: Math.max(150, 70 + 22 * Math.min(workers.length, 24)),
      x: { about: Format.about('time', unit), log: false },
      y: { about: Format.about('worker'), log: false, categories: workers },
      panels: [{ marks: [], columns }],
      legend: WorkView.outcomes
        .filter((one) => used.has(one))
        .map(({ name, series }) => ({ series, kind: 'column', name: Format.parts(name) })),
      table: {
        columns: ['worker', 'host', 'label', 'seed', 'began', 'ended', 'outcome'],
        rows: attempts.map((one) => [one.worker, one.host, data.points[one.point].label, one.seed, one.began, one.ended, one.outcome]),
      },
      caption: `The last ${Format.counted(attempts.length, 'attempt')}, since ${attempts[0].began.replace('T', ' ').replace('Z', ' UTC')}.`,
    };
  }
}

// Writes the reservations about the numbers: the meaning of marks, lost seeds by cause, and warnings of the engine.
function writeDoubts(data, host) {
  const losses = ({ label, losses: causes, loss_reasons: reasons }) =>
    Object.entries(causes).map(([cause, count]) => ({ point: label, cause, count, reason: reasons[cause] || '' }));
  const lost = data.points.flatMap(losses);
  const meanings = Object.entries(data.meanings);
  if (!lost.length && !meanings.length && !data.warnings.length) return;
  host.append(Page.heading('h2', 'What to know before using the numbers'));
  if (meanings.length) host.append(Page.list(meanings));
  if (lost.length) {
    const about = 'Lost seeds have ended without a value. Means leave them out.';
    host.append(Page.heading('h3', 'Lost seeds'), Page.paragraph(about, 'faint'));
    new SortedTable(
      host,
      [
        { title: 'point', text: true, wrap: true, value: (row) => row.point },
        { title: 'cause', text: true, value: (row) => row.cause },
        { title: 'seeds', value: (row) => row.count },
        { title: 'reason', text: true, wrap: true, value: (row) => row.reason },
      ],
      lost,
      { name: `${data.campaign} lost`, csv: { columns: ['label', 'cause', 'seeds', 'why'], rows: lost.map(Object.values) } },
    );
  }
  if (data.warnings.length) {
    host.append(Page.heading('h3', 'Warnings of the engine'));
    new SortedTable(
      host,
      [
        { title: 'point', text: true, wrap: true, value: (row) => row.point },
        { title: 'warning', text: true, wrap: true, value: (row) => row.code, shown: (row) => `${row.code}: ${row.message}` },
      ],
      data.warnings,
      { name: 'warnings' },
    );
  }
}

function writeCost(data, host, onPick) {
  host.append(Page.heading('h2', 'Cost'));
  const { seeds, cpu_seconds: time } = data.progress,
    said = [`${Format.counted(seeds.ended, 'seed')} ended in ${Format.duration(time)} of processor time`];
  if (seeds.lost) said.push(`${seeds.lost} of them without a value`);
  if (seeds.extra) said.push(`${seeds.extra} of them extra, beyond the stop test that decided their point`);
  host.append(Page.paragraph(`${said.join(', ')}.`));
  const details = Page.details('By point');
  host.append(details);
  const rows = data.points.map((point, i) => ({ point, i })),
    each = (row) => (row.point.seeds.ended ? row.point.cpu_seconds / row.point.seeds.ended : null);
  new SortedTable(
    details,
    [
      { title: 'point', text: true, wrap: true, value: (row) => row.point.label },
      { title: 'seeds', value: (row) => row.point.seeds.ended },
      { title: 'extra', minor: true, value: (row) => row.point.seeds.extra },
      {
        title: 'processor time',
        value: (row) => row.point.cpu_seconds,
        shown: (row) => Format.duration(row.point.cpu_seconds),
      },
      { title: 'per seed', value: each, shown: (row) => Format.duration(each(row)) },
    ],
    rows,
    {
      onPick: (row) => onPick(row.i),
      name: `${data.campaign} cost`,
      csv: {
        columns: ['label', 'seeds', 'extra', 'cpu_seconds'],
        rows: rows.map(({ point }) => [point.label, point.seeds.ended, point.seeds.extra, point.cpu_seconds]),
      },
    },
  );
}

// Returns the range of numbers, or the distinct words.
function range(values) {
  const numbers = values.filter(Format.isNumber);
  if (numbers.length !== values.length) return [...new Set(values.map((value) => Format.value(value)))].join(', ');
  const low = Math.min(...numbers),
    high = Math.max(...numbers);
  return low === high ? Format.plain(low) : `${Format.rough(low)} to ${Format.rough(high)}`;
}

// Joins the entries of a list, which are separate keys in the document, in one row.
function inOneRow(scene) {
  const rows = new Map();
  for (const key of scene) {
    const pointer = key.pointer.replace(/\/[0-9]+$/, ''),
      known = rows.get(pointer);
    if (known) known.value = `${Format.value(known.value)}, ${Format.value(key.value)}`;
    else rows.set(pointer, { ...key, pointer });
  }
  return [...rows.values()];
}

// Returns the swept parameters, the keys that have words, and the numbers that follow from the scenes, over all points.
function sceneSummary(data, sweep) {
  const items = [],
    named = new Set();
  for (const one of sweep.parameters) {
    if (!one.pointer) continue;
    items.push([Format.title(one.about), one.numeric ? range(one.cells) : one.values.join(', ')]);
    named.add(one.pointer.slice(1));
  }
  for (const key of data.scene) {
    if (!key.words) continue;
    items.push([Format.title(Format.parameter(key)), Format.value(key.value)]);
    named.add(key.pointer.slice(1));
  }
  const groups = data.points.map((point) => point.groups).filter(Boolean);
  for (const name of Object.keys(groups[0] || {})) {
    const values = groups.map((group) => group[name]).filter(Format.isNumber);
    if (values.length && !named.has(name)) items.push([Format.title(Format.group(name, data.derived)), range(values)]);
  }
  return items;
}

function writeOrigin(data, sweep, host) {
  host.append(Page.heading('h2', 'Where the numbers come from'));
  const scene = Page.details('The scene'),
    shared = inOneRow(data.scene).map((key) => ({ ...key, about: Format.parameter(key) }));
  scene.append(Page.list(sceneSummary(data, sweep)));
  if (shared.length) {
    scene.append(Page.paragraph(data.documents ? 'All points of a campaign share:' : 'All points share:', 'faint'));
    new SortedTable(
      scene,
      [
        {
          title: 'key',
          text: true,
          wrap: true,
          value: (row) => row.pointer,
          shown: (row) => row.pointer.slice(1).split('/').map(Format.words).join(': '),
        },
        { title: 'value', wrap: true, value: (row) => row.value, shown: (row) => Format.value(row.value) },
        { title: 'unit', text: true, value: (row) => row.about.unit, shown: (row) => Format.symbol(row.about.unit) },
        { title: 'meaning', text: true, wrap: true, minor: true, value: (row) => row.meaning },
      ],
      shared,
      { name: 'scene' },
    );
  }
  const provenance = Page.details('Engine, machines and checksums');
  provenance.append(Page.list(data.provenance));
  const again = Page.details('How to reproduce the numbers');
  again.append(
    Page.element('pre', {}, data.commands),
    Page.paragraph(
      'The same engine gives the same bytes with any number of workers: the checksum in the last line tells whether ' +
        'the numbers are the same. Another build gives other bytes, but means that agree within their errors.',
      'faint',
    ),
  );
  const files = data.documents || [{ name: data.campaign, document: data.document }],
    campaigns = files.map((one) => {
      const campaign = Page.details(`The campaign${data.documents ? ` ${one.name}` : ''}, as it was last run`),
        text = JSON.stringify(one.document, null, 2),
        file = Saving.link('JSON', `${one.name}.json`, 'application/json', text);
      campaign.append(Page.element('pre', {}, text), Saving.links(file));
      return campaign;
    });
  host.append(scene, provenance, again, ...campaigns);
}
