// The part of the page about one point: the convergence of its mean, the scatter of seeds, losses and cost.
class PointView {
  // `onPick(index)` is called when a point is chosen here.
  constructor(host, onPick) {
    this.select = Page.select([], () => onPick(Number(this.select.value)));
    this.charts = ['mean', 'width', 'scatter'].map(() => new Chart());
    this.details = new DetailsView();
    [this.facts, this.losses, this.numbers] = [1, 2, 3].map(() => Page.element('div'));
    host.append(
      Page.heading('h2', 'One point'),
      Page.element('div', { className: 'controls' }, Page.labelled('Point', this.select)),
      this.facts,
      Page.element('div', { className: 'pair' }, ...this.charts.map((chart) => chart.host)),
      this.details.host,
      this.losses,
      this.numbers,
    );
  }

  // Returns the axis of seeds, which is logarithmic if there are many.
  static seedsAxis(seeds) {
    const about = { words: 'seeds', symbol: Format.symbol('n'), unit: '' };
    return { about, log: seeds[seeds.length - 1] >= 20 * seeds[0] };
  }

  title(point, what) {
    return `${this.data.campaign} ${point.label} ${what}`;
  }

  // Returns the last stop test, or null.
  static last(point) {
    return point.stop_tests[point.stop_tests.length - 1] || null;
  }

  static stopTestMarks({ stop_tests: tests }, value, half) {
    const isDecided = (test) => /^(converged|complete)/.test(test.verdict) && test === tests[tests.length - 1];
    const text = (test) => `${Format.withError(test.mean, test.half_width)}, ${test.verdict}`;
    return tests
      .map((test) => ({
        series: 1,
        x: test.seeds,
        y: value(test),
        half: half(test),
        point: 0,
        small: true,
        kind: isDecided(test) ? 'decided' : 'undecided',
        text: `stop test at ${Format.counted(test.seeds, 'seed')}, ${text(test)}`,
      }))
      .filter((mark) => Format.isNumber(mark.y));
  }

  static stopTestTable({ stop_tests: tests, running_mean: { seeds, mean, half_width: half } }) {
    return {
      columns: ['kind', 'seeds', 'mean', 'half_width', 'good_enough', 'verdict'],
      rows: [
        ...seeds.map((count, i) => ['running', count, mean[i], half[i], null, null]),
        ...tests.map((test) => ['stop test', test.seeds, test.mean, test.half_width, test.good_enough, test.verdict]),
      ],
    };
  }

  convergence(point) {
    const { seeds, half_width: half } = point.running_mean,
      last = PointView.last(point),
      good = last && Format.isNumber(last.good_enough) ? last.good_enough : null;
    // The intervals of the first few seeds are enormous.
    const few = 8,
      isSettled = (i) => seeds[i] >= few || seeds[seeds.length - 1] <= few;
    const { lines, bands } = DetailsView.curve(seeds, point.running_mean, isSettled),
      widths = seeds.map((count, i) => [count, half[i]]).filter(([, width], i) => Format.isNumber(width) && isSettled(i));
    const levels = good === null ? [] : [last.mean - good, last.mean + good];
    const level = (value) => ({ value, across: true, series: 2 });
    const x = PointView.seedsAxis(seeds),
      table = PointView.stopTestTable(point),
      legend = point.stop_tests.length ? [{ series: 1, name: Format.parts('stop tests') }] : [];
    const width = (test) => test.half_width,
      means = PointView.stopTestMarks(point, (test) => test.mean, width);
    return [
      {
        name: this.title(point, 'running mean'),
        x,
        y: { about: this.about, log: false },
        table,
        legend,
        panels: [{ marks: means, levels: levels.map(level), lines, bands }],
        hasBand: bands.length > 0,
        bandName: 'interval of the mean',
        height: 260,
        caption: `Running mean over the first n seeds with its interval, and the stop tests.${
          levels.length ? ' Dashed: the mean at the last stop test ± the allowed half-width.' : ''
        }`,
      },
      {
        name: this.title(point, 'half-width'),
        x,
        table,
        legend,
        y: { about: Format.about('half-width', this.about.unit), log: isLogarithmic(half.filter(Format.isNumber)) },
        panels: [
          {
            marks: PointView.stopTestMarks(point, width, () => null),
            levels: good === null ? [] : [level(good)],
            lines: [{ series: 0, style: 'line', places: widths }],
          },
        ],
        height: 260,
        caption: `Half-width of the interval by which stop tests decide.${last ? ' Dashed: the allowed half-width.' : ''}`,
      },
    ];
  }

  scatter(point) {
    const { scatter, running_mean: running } = point,
      last = PointView.last(point),
      mean = last ? last.mean : running.mean[running.mean.length - 1];
    const level = (across) => (Format.isNumber(mean) ? [{ value: mean, across, series: 1 }] : []),
      axis = (about) => ({ about, log: false });
    const figure = (panel, x, y, table, caption) => ({
      name: this.title(point, 'seeds'),
      height: 260,
      panels: [panel],
      x: axis(x),
      y: axis(y),
      table,
      caption,
    });
    if (scatter.counts) {
      const width = (scatter.high - scatter.low) / scatter.counts.length || 1,
        edge = (i) => scatter.low + i * width;
      const columns = scatter.counts.map((high, i) => ({ from: edge(i), to: edge(i + 1), low: 0, high, series: 0 })),
        table = { columns: ['from', 'to', 'seeds'], rows: columns.map(({ from, to, high }) => [from, to, high]) },
        panel = { marks: [], levels: level(false), columns };
      return figure(panel, this.about, Format.about('seeds'), table, 'Distribution of the values. Dashed: their mean.');
    }
    const rows = scatter.values.map((y, i) => [scatter.seeds[i] - 1, y]),
      text = (seed, y) => `seed ${seed}: ${Format.plain(y)}`,
      like = { half: null, kind: 'decided', small: true, point: 0 };
    const marks = rows.map(([x, y]) => ({ series: 0, x, y, ...like, text: text(x, y) })),
      table = { columns: ['seed', 'value'], rows },
      panel = { marks, levels: level(true) };
    return figure(panel, Format.about('seed'), this.about, table, 'The value of each seed. Dashed: their mean.');
  }

  sentences(point) {
    const last = PointView.last(point),
      { seeds } = point,
      estimate = this.column < 0 ? null : point.estimates[this.column],
      said = [];
    if (last) {
      const relative = this.data.target.relative_tolerance !== undefined && !this.data.target.relative_to,
        hasShare = relative && last.mean && Format.isNumber(last.half_width),
        share = hasShare ? ` (${Format.percent(last.half_width / Math.abs(last.mean))})` : '',
        test = Format.counted(last.seeds, 'seed');
      said.push(`${Format.withError(last.mean, last.half_width)}${share}: ${point.verdict}, at the stop test with ${test}.`);
      const plain = point.plain[this.path];
      if (plain && plain[0] !== last.mean) {
        const text = 'Without the control variate, a quantity of known mean zero that reduces the scatter';
        said.push(`${text}: ${Format.withError(plain[0], plain[2])}.`);
      }
    } else if (estimate && Format.isNumber(estimate[0])) {
      const mean = Format.withError(estimate[0], estimate[2]),
        seeds = Format.counted(estimate[3], 'seed');
      said.push(`${mean}, the mean of all seeds that have ended (${seeds}): provisional, ${point.verdict}.`);
    } else {
      said.push(`There is no value yet: ${point.verdict}.`);
    }
    const { ended, jammed, has_jammed: hasJammed } = point.endings;
    if (hasJammed) said.push(`The point has jammed, in ${jammed} of ${Format.counted(ended, 'seed')}.`);
    if (!point.decided) said.push(`${seeds.wanted_ended} of the ${seeds.wanted} seeds of the next stop test have ended.`);
    const each = seeds.ended ? `, ${Format.duration(point.cpu_seconds / seeds.ended)} each` : '';
    const extra = seeds.extra ? `; ${seeds.extra} of them are extra and do not count` : '';
    said.push(
      `Processor time ${Format.duration(point.cpu_seconds)} for ${Format.counted(seeds.ended, 'seed')}${each}${extra}.`,
    );
    return said.join(' ');
  }

  show(data, index) {
    const point = data.points[index];
    Object.assign(this, { data }, Sweep.aim(data));
    const labels = data.points.map((one, i) => [String(i), one.label]);
    Page.refill(this.select, labels);
    this.select.value = String(index);
    const groups = Object.entries(point.groups || {}).filter(([, value]) => Format.isNumber(value));
    this.facts.replaceChildren(Page.paragraph(this.sentences(point)));
    if (groups.length) this.facts.append(Page.paragraph(PointView.groups(groups, data.derived), 'faint'));
    const empty = point.decided ? 'There is nothing to draw, because no seed has a value.' : '';
    const figures = [...this.convergence(point), this.scatter(point)].map((figure) => ({ ...figure, empty }));
    this.charts.forEach((chart, i) => chart.show(figures[i]));
    this.details.show(data, point, this.about);
    this.losses.replaceChildren();
    const causes = Object.entries(point.losses).map(([cause, count]) => `${count} ${Format.words(cause)}`);
    if (causes.length)
      this.losses.append(Page.paragraph(`The mean leaves out the lost seeds: ${causes.join(', ')}.`));
    const shown = [point.hash, data.quantities, point.estimates, point.plain];
    Page.renew(this.numbers, shown, () => this.showNumbers(point));
  }

  // Returns the parts of "Péclet number Pe 10 · Stokes number St 0.01".
  static groups(groups, known) {
    return groups.flatMap(([name, value], i) => [
      ...Format.parts(i ? ' · ' : ''),
      ...Format.title({ ...Format.group(name, known), unit: '' }),
      ...Format.parts(` ${Format.rough(value)}`),
    ]);
  }

  // Shows the table of all quantities that were measured at the point.
  showNumbers(point) {
    const rows = this.data.quantities
      .map((quantity, i) => ({
        about: Format.quantity(quantity),
        quantity,
        numbers: point.estimates[i] || [null],
        plain: point.plain[quantity.path],
      }))
      .filter((row) => Format.isNumber(row.numbers[0]));
    const symbol = (row) => Format.plainText(row.about.symbol),
      mean = (row) => Format.withError(row.numbers[0], row.numbers[2]);
    const plain = {
      title: 'without control variate',
      minor: true,
      value: (row) => (row.plain ? row.plain[0] : null),
      shown: (row) => (row.plain ? Format.withError(row.plain[0], row.plain[2]) : ''),
    };
    const details = Page.details(`All quantities measured at this point (${rows.length} numbers)`);
    this.numbers.append(details);
    new SortedTable(
      details,
      [
        { title: 'quantity', text: true, wrap: true, value: (row) => row.about.words },
        { title: 'symbol', text: true, minor: true, value: symbol, shown: (row) => row.about.symbol },
        { title: 'mean ± half-width', value: (row) => row.numbers[0], shown: mean },
        { title: 'unit', text: true, value: (row) => row.about.unit, shown: (row) => Format.symbol(row.about.unit) },
        ...(rows.some((row) => row.plain) ? [plain] : []),
        { title: 'seeds', value: (row) => row.numbers[3] },
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

// The charts of a point's details: the course of the target within the measured window, profiles and distributions.
class DetailsView {
  constructor() {
    this.host = Page.element('div', { className: 'pair' });
    this.charts = [];
  }

  // Draws the details. On a live page there are none until the server has sent them.
  show(data, point, about) {
    const details = point.details || Live.details(point);
    const figures = details
      ? [...DetailsView.blocks(data, point, about, details), ...DetailsView.profiles(data, point, details)]
      : [];
    while (this.charts.length > figures.length) this.charts.pop().host.remove();
    figures.forEach((figure, i) => {
      if (!this.charts[i]) {
        this.charts.push(new Chart());
        this.host.append(this.charts[i].host);
      }
      this.charts[i].show(figure);
    });
  }

  static seeds({ seeds, of }) {
    return seeds < of ? `the first ${seeds} of ${of} seeds` : Format.counted(seeds, 'seed');
  }

  // Returns a line with its interval where that is settled. The line skips values that do not exist.
  static curve(xs, { mean, half_width: half }, isSettled = () => true) {
    const known = xs.map((_, i) => i).filter((i) => Format.isNumber(mean[i])),
      banded = known.filter((i) => Format.isNumber(half[i]) && isSettled(i)),
      band = banded.map((i) => [xs[i], mean[i] - half[i], mean[i] + half[i]]);
    return {
      marks: [],
      lines: [{ series: 0, style: 'line', places: known.map((i) => [xs[i], mean[i]]) }],
      bands: banded.length ? [{ series: 0, places: band }] : [],
    };
  }

  static blocks(data, point, about, details) {
    if (!details.blocks) return [];
    const { mean, half_width: half } = details.blocks,
      parts = mean.length,
      xs = mean.map((_, i) => (100 * (i + 0.5)) / parts);
    const known = mean.filter(Format.isNumber),
      whole = known.reduce((sum, value) => sum + value, 0) / known.length;
    const verdict = point.marks.includes('transient')
      ? 'Transient: the beginning differs from the end, so that the window begins before the equilibration is over.'
      : point.marks.includes('no-transient-test')
        ? 'There was no test for a transient.'
        : point.stop_tests.length
          ? 'No transient was found at the last stop test.'
          : 'There was no stop test yet, and so no test for a transient.';
    return [
      {
        name: `${data.campaign} ${point.label} window`,
        height: 260,
        x: { about: Format.about('position in the measured window', '%'), log: false },
        y: { about, log: false },
        panels: [{ ...DetailsView.curve(xs, details.blocks), levels: [{ value: whole, across: true, series: 1 }] }],
        table: { columns: ['window_percent', 'mean', 'half_width'], rows: xs.map((x, i) => [x, mean[i], half[i]]) },
        hasBand: half.some(Format.isNumber),
        bandName: 'interval of the mean',
        caption: `Course within the window: mean of ${DetailsView.seeds(details)} in each of ${parts} parts. ${verdict}`,
      },
    ];
  }

  static profiles(data, point, details) {
    return details.profiles.map((profile) => {
      const { axis } = profile,
        about = Format.quantity({ ...profile, element: '' }),
        log = isLogarithmic(axis.values);
      return {
        name: `${data.campaign} ${point.label} ${profile.name}`,
        height: 260,
        x: { about: Format.about(Format.words(axis.name), Format.unit(axis.unit)), log },
        y: { about, log: false },
        panels: [DetailsView.curve(axis.values, profile)],
        table: {
          columns: [axis.name, 'mean', 'standard_error', 'half_width'],
          rows: axis.values.map((x, i) => [x, profile.mean[i], profile.standard_error[i], profile.half_width[i]]),
        },
        hasBand: profile.half_width.some(Format.isNumber),
        bandName: 'interval of the mean',
        caption: `${about.words}: mean of ${DetailsView.seeds(details)}.`,
      };
    });
  }
}
