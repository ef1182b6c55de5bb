// Who works on what: the workers now, and the attempts that ended last as a chart over time.
class WorkView {
  constructor(host) {
    this.now = document.createElement('div');
    this.chart = new Chart(document.createElement('figure'));
    host.append(Page.heading('h2', 'Who works on what'), this.now, this.chart.host);
  }

  show(data) {
    Page.renew(this.now, data.work.now, (host) => {
      if (data.work.now.length) WorkView.table(data, host);
    });
    this.chart.show(WorkView.figure(data));
  }

  static table(data, host) {
    const done = (row) => (row.steps > 0 ? row.step / row.steps : null),
      label = (row) => data.points[row.point].label;
    new SortedTable(
      host,
      [
        { title: 'worker', cell: (row) => String(row.worker), sort: (row) => row.worker },
        { title: 'point', text: true, wrap: true, cell: label, sort: label },
        { title: 'seed', cell: (row) => String(row.seed), sort: (row) => row.seed },
        { title: 'phase', text: true, minor: true, cell: (row) => row.phase, sort: (row) => row.phase },
        { title: 'done', cell: (row) => (Format.isNumber(done(row)) ? `${Math.round(100 * done(row))} %` : '–'), sort: done },
        { title: 'strain', minor: true, cell: (row) => Format.rough(row.strain), sort: (row) => row.strain },
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

  // Times are those of the owner's clock, to a second.
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
      x: { about: { words: 'time', symbol: [], unit }, log: false },
      y: { about: { words: 'worker', symbol: [], unit: '' }, log: false, categories: workers },
      panels: [{ marks: [], columns }],
      legend: WorkView.outcomes
        .filter((one) => used.has(one))
        .map(({ name, series }) => ({ series, kind: 'column', name: [{ text: name, level: 0 }] })),
      table: {
        columns: ['worker', 'host', 'label', 'seed', 'began', 'ended', 'outcome'],
        rows: attempts.map((one) => [one.worker, one.host, data.points[one.point].label, one.seed, one.began, one.ended, one.outcome]),
      },
      caption: `The last ${Format.counted(attempts.length, 'attempt')}, from ${attempts[0].began.replace('T', ' ').replace('Z', ' UTC')} on.`,
    };
  }
}
