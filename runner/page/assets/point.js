// What is known of one point: how its mean came about, how seeds scatter, what was lost, what it cost. The figures are
// pure; `show` writes them down.
class PointView {
  // `onPick(index)`: a point was chosen here.
  constructor(host, onPick) {
    this.select = Page.select([], () => onPick(Number(this.select.value)));
    this.facts = document.createElement('div');
    this.charts = ['mean', 'width', 'scatter'].map(() => new Chart(document.createElement('figure')));
    this.details = new DetailsView();
    this.losses = document.createElement('div');
    this.numbers = document.createElement('div');
    const pair = document.createElement('div');
    pair.className = 'pair';
    pair.append(...this.charts.map((chart) => chart.host));
    const controls = document.createElement('div');
    controls.className = 'controls';
    controls.append(Page.labelled('Point', this.select));
    host.append(
      Page.heading('h2', 'One point'),
      controls,
      this.facts,
      pair,
      this.details.host,
      this.losses,
      this.numbers,
    );
  }

  seedsAxis(log) {
    return { about: { words: 'seeds', symbol: Format.symbol('n'), unit: '' }, log };
  }

  static isLong(seeds) {
    return seeds[seeds.length - 1] >= 20 * seeds[0];
  }

  title(point, what) {
    return `${this.data.campaign} ${point.label} ${what}`;
  }

  // The last look's, or what the seeds so far say.
  static last(point) {
    return point.looks[point.looks.length - 1] || null;
  }

  lookMarks(point, value, half) {
    return point.looks
      .map((look, i) => ({
        series: 1,
        x: look.seeds,
        y: value(look),
        half: half(look),
        point: 0,
        small: true,
        kind: /^(converged|complete)/.test(look.verdict) && i === point.looks.length - 1 ? 'decided' : 'undecided',
        text: [
          `look at ${Format.counted(look.seeds, 'seed')}`,
          Format.withError(look.mean, look.half_width),
          look.verdict,
        ].join(', '),
      }))
      .filter((mark) => Format.isNumber(mark.y));
  }

  lookRows(point) {
    return [
      ...point.running_mean.seeds.map((seeds, i) => [
        'running',
        seeds,
        point.running_mean.mean[i],
        point.running_mean.half_width[i],
        null,
        null,
      ]),
      ...point.looks.map((look) => ['look', look.seeds, look.mean, look.half_width, look.good_enough, look.verdict]),
    ];
  }

  convergence(point) {
    const { seeds, mean, half_width: half } = point.running_mean,
      last = PointView.last(point),
      levels = [];
    const usable = seeds.map((_, i) => i).filter((i) => Format.isNumber(mean[i]));
    // The intervals of the first few seeds are enormous.
    const few = 8;
    const settled = usable.filter(
      (i) => Format.isNumber(half[i]) && (seeds[i] >= few || seeds[seeds.length - 1] <= few),
    );
    if (last && Format.isNumber(last.good_enough)) {
      for (const sign of [-1, 1])
        levels.push({ value: last.mean + sign * last.good_enough, across: true, series: 2 });
    }
    const table = {
      columns: ['kind', 'seeds', 'mean', 'half_width', 'good_enough', 'verdict'],
      rows: this.lookRows(point),
    };
    const legend = point.looks.length ? [{ series: 1, name: [{ text: 'looks', level: 0 }] }] : [];
    return [
      {
        name: this.title(point, 'running mean'),
        x: this.seedsAxis(PointView.isLong(seeds)),
        y: { about: this.about, log: false },
        table,
        legend,
        panels: [
          {
            marks: this.lookMarks(
              point,
              (look) => look.mean,
              (look) => look.half_width,
            ),
            levels,
            lines: [{ series: 0, style: 'line', places: usable.map((i) => [seeds[i], mean[i]]) }],
            bands: settled.length
              ? [{ series: 0, places: settled.map((i) => [seeds[i], mean[i] - half[i], mean[i] + half[i]]) }]
              : [],
          },
        ],
        hasBand: settled.length > 0,
        bandName: 'its interval',
        height: 260,
        caption: `Running mean over the first n seeds, its interval, and the looks at which it was judged.${
          levels.length ? " Dashed: the last look's mean ± the half-width that is good enough." : ''
        }`,
      },
      {
        name: this.title(point, 'half-width'),
        x: this.seedsAxis(PointView.isLong(seeds)),
        table,
        legend,
        y: {
          about: { words: 'half-width', symbol: [], unit: this.about.unit },
          log: isLogarithmic(half.filter(Format.isNumber)),
        },
        panels: [
          {
            marks: this.lookMarks(
              point,
              (look) => look.half_width,
              () => null,
            ),
            levels:
              last && Format.isNumber(last.good_enough) ? [{ value: last.good_enough, across: true, series: 2 }] : [],
            lines: [{ series: 0, style: 'line', places: settled.map((i) => [seeds[i], half[i]]) }],
          },
        ],
        height: 260,
        caption: `Half-width of the interval by which looks decide.${last ? ' Dashed: what is good enough.' : ''}`,
      },
    ];
  }

  scatter(point) {
    const { scatter } = point,
      last = PointView.last(point),
      levels = [];
    const mean = last ? last.mean : point.running_mean.mean[point.running_mean.mean.length - 1];
    const figure = { name: this.title(point, 'seeds'), height: 260, panels: [{ marks: [], levels }] },
      [panel] = figure.panels;
    if (scatter.counts) {
      const width = (scatter.high - scatter.low) / scatter.counts.length || 1;
      if (Format.isNumber(mean)) levels.push({ value: mean, across: false, series: 1 });
      panel.columns = scatter.counts.map((height, i) => ({
        from: scatter.low + i * width,
        to: scatter.low + (i + 1) * width,
        low: 0,
        high: height,
        series: 0,
      }));
      return {
        ...figure,
        x: { about: this.about, log: false },
        y: { about: { words: 'seeds', symbol: [], unit: '' }, log: false },
        table: {
          columns: ['from', 'to', 'seeds'],
          rows: panel.columns.map((column) => [column.from, column.to, column.high]),
        },
        caption: 'How many seeds gave which value. Dashed: their mean.',
      };
    }
    if (Format.isNumber(mean)) levels.push({ value: mean, across: true, series: 1 });
    panel.marks = scatter.values.map((y, i) => ({
      series: 0,
      x: scatter.seeds[i] - 1,
      y,
      half: null,
      kind: 'decided',
      small: true,
      point: 0,
      text: `seed ${scatter.seeds[i] - 1}: ${Format.plain(y)}`,
    }));
    return {
      ...figure,
      x: { about: { words: 'seed', symbol: [], unit: '' }, log: false },
      y: { about: this.about, log: false },
      table: { columns: ['seed', 'value'], rows: scatter.values.map((y, i) => [scatter.seeds[i] - 1, y]) },
      caption: 'The value of each seed. Dashed: their mean.',
    };
  }

  // In sentences.
  sentences(point) {
    const last = PointView.last(point),
      { seeds } = point,
      estimate = this.column < 0 ? null : point.estimates[this.column],
      said = [];
    if (last) {
      const relative = this.data.target.relative_tolerance !== undefined && !this.data.target.relative_to;
      const share = relative && last.mean && Format.isNumber(last.half_width) ? ` (${Format.percent(last.half_width / Math.abs(last.mean))})` : '';
      const look = Format.counted(last.seeds, 'seed');
      said.push(`${Format.withError(last.mean, last.half_width)}${share}: ${point.verdict}, at the look at ${look}.`);
      const plain = point.uncontrolled[this.data.target.observable.replace(/^\//, '')];
      if (plain && plain[0] !== last.mean) {
        const text = 'Without the control variate, a quantity of known mean zero that takes away scatter';
        said.push(`${text}: ${Format.withError(plain[0], plain[2])}.`);
      }
    } else if (estimate && Format.isNumber(estimate[0])) {
      const mean = Format.withError(estimate[0], estimate[2]),
        seeds = Format.counted(estimate[3], 'seed');
      said.push(`${mean} over the ${seeds} so far: provisional, ${point.verdict}.`);
    } else {
      said.push(`Nothing is known yet: ${point.verdict}.`);
    }
    const { ended, jammed, has_jammed: hasJammed } = point.endings;
    if (hasJammed) said.push(`It has jammed: ${jammed} of ${Format.counted(ended, 'seed')}.`);
    if (!point.decided) said.push(`${seeds.wanted_ended} of the ${seeds.wanted} seeds of the next look have ended.`);
    const each = seeds.ended ? `, ${Format.duration(point.cpu_seconds / seeds.ended)} each` : '';
    said.push(
      `Processor time ${Format.duration(point.cpu_seconds)} for ${Format.counted(seeds.ended, 'seed')}${each}${
        seeds.surplus ? `; ${seeds.surplus} of them surplus, which do not count` : ''
      }.`,
    );
    return said.join(' ');
  }

  show(data, index) {
    const point = data.points[index],
      path = data.target.observable.replace(/^\//, '');
    this.data = data;
    this.column = data.quantities.findIndex((quantity) => quantity.path === path);
    this.about =
      this.column < 0
        ? { words: Format.words(path), symbol: [], unit: '' }
        : Format.quantity(data.quantities[this.column]);
    Page.refill(
      this.select,
      data.points.map((one, i) => [String(i), one.label]),
    );
    this.select.value = String(index);
    const groups = Object.entries(point.groups || {}).filter(([, value]) => Format.isNumber(value));
    this.facts.replaceChildren(Page.paragraph(this.sentences(point)));
    if (groups.length)
      this.facts.append(Page.paragraph(PointView.groups(groups, data.derived), 'faint'));
    const empty = point.decided ? 'Nothing to draw: no seed has a value.' : '';
    const figures = [...this.convergence(point), this.scatter(point)].map((figure) => ({ ...figure, empty }));
    this.charts.forEach((chart, i) => chart.show(figures[i]));
    this.details.show(data, point, this.about);
    this.losses.replaceChildren();
    const causes = Object.entries(point.losses);
    if (causes.length) {
      this.losses.append(
        Page.paragraph(
          `Lost seeds, which the mean leaves out: ${causes
            .map(([cause, count]) => `${count} ${Format.words(cause)}`)
            .join(', ')}.`,
        ),
      );
    }
    const shown = [point.hash, data.quantities, point.estimates, point.uncontrolled];
    Page.renew(this.numbers, shown, () => this.showNumbers(point));
  }

  // "Péclet number Pe 10 · Stokes number St 0.01" as parts.
  static groups(groups, known) {
    return groups.flatMap(([name, value], i) => [
      { text: i ? ' · ' : '', level: 0 },
      ...Format.title({ ...Format.group(name, known), unit: '' }),
      { text: ` ${Format.rough(value)}`, level: 0 },
    ]);
  }

  // Everything that was measured at the point.
  showNumbers(point) {
    const { quantities } = this.data,
      rows = [];
    quantities.forEach((quantity, i) => {
      if (point.estimates[i] && Format.isNumber(point.estimates[i][0]))
        rows.push({
          about: Format.quantity(quantity),
          quantity,
          numbers: point.estimates[i],
          plain: point.uncontrolled[quantity.path],
        });
    });
    const details = Page.details(`All that was measured at this point (${rows.length} numbers)`);
    this.numbers.append(details);
    new SortedTable(
      details,
      [
        { title: 'quantity', text: true, wrap: true, cell: (row) => row.about.words, sort: (row) => row.about.words },
        {
          title: 'symbol',
          text: true,
          minor: true,
          cell: (row) => row.about.symbol,
          sort: (row) => Format.plainText(row.about.symbol),
        },
        {
          title: 'mean ± half-width',
          cell: (row) => Format.withError(row.numbers[0], row.numbers[2]),
          sort: (row) => row.numbers[0],
        },
        { title: 'unit', text: true, cell: (row) => Format.symbol(row.about.unit), sort: (row) => row.about.unit },
        ...(rows.some((row) => row.plain)
          ? [
              {
                title: 'without control variate',
                minor: true,
                cell: (row) => (row.plain ? Format.withError(row.plain[0], row.plain[2]) : ''),
                sort: (row) => (row.plain ? row.plain[0] : null),
              },
            ]
          : []),
        { title: 'seeds', cell: (row) => String(row.numbers[3]), sort: (row) => row.numbers[3] },
      ],
      rows,
      {
        name: this.title(point, 'measured'),
        csv: {
          columns: ['quantity', 'symbol', 'unit', 'mean', 'standard_error', 'half_width', 'count'],
          rows: rows.map((row) => [row.quantity.path, row.quantity.symbol, row.quantity.unit, ...row.numbers]),
        },
      },
    );
  }
}
