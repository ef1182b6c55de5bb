// What each section shows, so that it is made anew only when that has changed.
const doubtsShown = (data) => [data.points.map((point) => [point.label, point.losses, point.loss_reasons]), data.meanings, data.warnings],
  costShown = (data) => [data.progress.seeds, data.points.map(({ label, seeds, cpu_seconds }) => [label, seeds.ended, seeds.surplus, cpu_seconds])],
  originShown = (data) => [data.scene, data.parameters, data.provenance, data.commands, data.document, data.points.map((point) => point.groups)];

// What may be doubted: lost seeds by cause, what each mark means, what engines warn of.
function writeDoubts(data, host) {
  const lost = data.points.flatMap((point) =>
    Object.entries(point.losses).map(([cause, count]) => ({ point: point.label, cause, count, reason: point.loss_reasons[cause] || '' })),
  );
  const meanings = Object.entries(data.meanings);
  if (!lost.length && !meanings.length && !data.warnings.length) return;
  host.append(Page.heading('h2', 'What to know before using the numbers'));
  if (meanings.length) host.append(Page.list(meanings));
  if (lost.length) {
    host.append(
      Page.heading('h3', 'Lost seeds'),
      Page.paragraph('Seeds that ended without a value. Means leave them out.', 'faint'),
    );
    new SortedTable(
      host,
      [
        { title: 'point', text: true, wrap: true, cell: (row) => row.point, sort: (row) => row.point },
        { title: 'cause', text: true, cell: (row) => row.cause, sort: (row) => row.cause },
        { title: 'seeds', cell: (row) => String(row.count), sort: (row) => row.count },
        { title: 'why', text: true, wrap: true, cell: (row) => row.reason, sort: (row) => row.reason },
      ],
      lost,
      {
        name: `${data.campaign} lost`,
        csv: {
          columns: ['label', 'cause', 'seeds', 'why'],
          rows: lost.map((row) => [row.point, row.cause, row.count, row.reason]),
        },
      },
    );
  }
  if (data.warnings.length) {
    host.append(Page.heading('h3', 'Warnings of the engine'));
    new SortedTable(
      host,
      [
        { title: 'point', text: true, wrap: true, cell: (row) => row.point, sort: (row) => row.point },
        {
          title: 'warning',
          text: true,
          wrap: true,
          cell: (row) => `${row.code}: ${row.message}`,
          sort: (row) => row.code,
        },
      ],
      data.warnings,
      { name: 'warnings' },
    );
  }
}

function writeCost(data, host, onPick) {
  host.append(Page.heading('h2', 'Cost'));
  const { progress } = data,
    { seeds } = progress;
  const said = [
    `${Format.counted(seeds.ended, 'seed')} ended in ${Format.duration(progress.cpu_seconds)} of processor time`,
  ];
  if (seeds.lost) said.push(`${seeds.lost} of them without a value`);
  if (seeds.surplus) said.push(`${seeds.surplus} beyond what decided their point`);
  host.append(Page.paragraph(`${said.join(', ')}.`));
  const details = Page.details('By point');
  host.append(details);
  const rows = data.points.map((point, i) => ({ point, i })),
    each = (row) => (row.point.seeds.ended ? row.point.cpu_seconds / row.point.seeds.ended : null);
  new SortedTable(
    details,
    [
      { title: 'point', text: true, wrap: true, cell: (row) => row.point.label, sort: (row) => row.point.label },
      { title: 'seeds', cell: (row) => String(row.point.seeds.ended), sort: (row) => row.point.seeds.ended },
      {
        title: 'surplus',
        minor: true,
        cell: (row) => String(row.point.seeds.surplus),
        sort: (row) => row.point.seeds.surplus,
      },
      {
        title: 'processor time',
        cell: (row) => Format.duration(row.point.cpu_seconds),
        sort: (row) => row.point.cpu_seconds,
      },
      { title: 'a seed', cell: (row) => Format.duration(each(row)), sort: each },
    ],
    rows,
    {
      onPick: (row) => onPick(row.i),
      name: `${data.campaign} cost`,
      csv: {
        columns: ['label', 'seeds', 'surplus', 'cpu_seconds'],
        rows: rows.map(({ point }) => [point.label, point.seeds.ended, point.seeds.surplus, point.cpu_seconds]),
      },
    },
  );
}

// From the smallest to the largest of numbers, or the words.
function range(values) {
  const numbers = values.filter(Format.isNumber);
  if (numbers.length !== values.length) return [...new Set(values.map((value) => Format.value(value)))].join(', ');
  const low = Math.min(...numbers),
    high = Math.max(...numbers);
  return low === high ? Format.plain(low) : `${Format.rough(low)} to ${Format.rough(high)}`;
}

// Entries of a list of words or numbers, which stand one by one in the document, in one row.
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

// What the sweep sets, the keys that have words, and the numbers that follow, over all points.
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
  for (const name of groups.length ? Object.keys(groups[0]) : []) {
    const values = groups.map((group) => group[name]).filter(Format.isNumber);
    if (values.length && !named.has(name)) items.push([Format.title(Format.group(name, data.derived)), range(values)]);
  }
  return items;
}

function writeOrigin(data, sweep, host) {
  host.append(Page.heading('h2', 'Where this comes from'));
  const scene = Page.details('The scene'),
    shared = inOneRow(data.scene).map((key) => ({ ...key, about: Format.parameter(key) }));
  scene.append(Page.list(sceneSummary(data, sweep)));
  if (shared.length) {
    scene.append(Page.paragraph('All points share:', 'faint'));
    new SortedTable(
      scene,
      [
        {
          title: 'key',
          text: true,
          wrap: true,
          cell: (row) => row.pointer.slice(1).split('/').map(Format.words).join(': '),
          sort: (row) => row.pointer,
        },
        { title: 'value', wrap: true, cell: (row) => Format.value(row.value), sort: (row) => row.value },
        { title: 'unit', text: true, cell: (row) => Format.symbol(row.about.unit), sort: (row) => row.about.unit },
        {
          title: 'meaning',
          text: true,
          wrap: true,
          minor: true,
          cell: (row) => row.meaning,
          sort: (row) => row.meaning,
        },
      ],
      shared,
      { name: 'scene' },
    );
  }
  const provenance = Page.details('Engine, machines and checksums');
  provenance.append(Page.list(data.provenance));
  const again = Page.details('To make it again'),
    commands = document.createElement('pre');
  commands.textContent = data.commands;
  again.append(
    commands,
    Page.paragraph(
      'The same engine gives the same bytes with any number of workers: the last line tells whether ' +
        'the numbers are the same. Another build gives other bytes, and means that agree within their errors.',
      'faint',
    ),
  );
  const campaign = Page.details('The campaign, as it was last run'),
    text = document.createElement('pre');
  text.textContent = JSON.stringify(data.document, null, 2);
  campaign.append(
    text,
    Saving.links(Saving.link('JSON', `${data.campaign}.json`, 'application/json', text.textContent)),
  );
  host.append(scene, provenance, again, campaign);
}
