// The swept parameters of a campaign, and figures of measured quantities over them.
class Sweep {
  constructor(data) {
    this.data = data;
    this.points = data.points;
    this.parameters = data.parameters.map((parameter) => this.column(parameter));
    if (this.parameters.length === 0) {
      const labels = this.points.map((point) => point.label);
      this.parameters = [{ pointer: '', about: Format.about('point'), numeric: false, values: labels, cells: labels }];
    }
    const first = this.parameters
      .filter((one) => one.numeric && one.values.length > 1)
      .reduce((best, one) => (!best || one.values.length > best.values.length ? one : best), null);
    this.derived = new Derived(data);
    this.axes = [...this.parameters, ...this.derived.axes()];
    this.usual = first || this.parameters.find((one) => one.values.length > 1) || this.parameters[0];
  }

  static bare(path) {
    return path.replace(/^\//, '');
  }

  // Returns the target's path, its column among the quantities (-1 if not measured yet), and its description.
  static aim({ target, quantities }) {
    const path = Sweep.bare(target.observable),
      column = quantities.findIndex((quantity) => quantity.path === path),
      about = column < 0 ? Format.about(Format.words(path)) : Format.quantity(quantities[column]);
    return { path, column, about };
  }

  // Returns a parameter with the cell of each point and its distinct values in order. Cells are all numbers or all words.
  column(parameter) {
    const { pointer, meaning } = parameter,
      raw = this.points.map((point) => point.settings[pointer]);
    const numeric = raw.every(Format.isNumber),
      texts = [...new Set(raw.map((value) => JSON.stringify(value)))];
    const word = (value) => {
      const text = JSON.stringify(value),
        longest = 26;
      if (text === undefined) return '–';
      return text.length > longest ? `#${texts.indexOf(text) + 1}` : Format.value(value);
    };
    const cells = numeric ? raw : raw.map(word),
      values = [...new Set(cells)];
    if (numeric) values.sort((a, b) => a - b);
    return { pointer, meaning, about: Format.parameter(parameter), numeric, cells, values };
  }

  // True if the value of `other` follows from that of `axis`. The name of a campaign always tells curves apart.
  isInStep(other, axis) {
    if (other.pointer === 'campaign') return false;
    const partner = new Map();
    return this.points.every((_, i) => {
      const known = partner.get(axis.cells[i]);
      if (known === undefined) partner.set(axis.cells[i], other.cells[i]);
      return known === undefined || known === other.cells[i];
    });
  }

  // Returns the parameters that distinguish curves over `axis`.
  others(axis) {
    return this.parameters.filter((one) => one !== axis && one.values.length > 1 && !this.isInStep(one, axis));
  }

  // Returns the parameters by which panels are made unless chosen: none if the curves are few enough to be distinguished,
  // all others if each point has several numbers, otherwise the one with the fewest values.
  usualPanels(axis, perPoint = 1) {
    const mostPanels = 12,
      others = this.others(axis);
    const combinations = others.reduce((product, one) => product * one.values.length, 1);
    if (perPoint > 1 && combinations <= mostPanels) return others;
    if (others.length === 0 || (others.length === 1 && combinations * perPoint <= Svg.colours)) return [];
    return [others.reduce((best, one) => (one.values.length < best.values.length ? one : best))];
  }

  // Returns the quantities that can be drawn, the target first. Sums that are split by term are choices of their own:
  // quantities with the same first name and the same element, such as stress/...
  choices() {
    const { quantities, target } = this.data,
      targets = [target, ...(target.also || [])].map((one) => Sweep.bare(one.observable));
    const groupOf = (quantity) => {
      if (targets.includes(quantity.path)) return 'target';
      if (quantity.name.startsWith('control_variates/')) return 'control variates';
      return quantity.element ? 'components' : 'measured';
    };
    const drawn = quantities.map((quantity, index) => ({
      id: quantity.path,
      indices: [index],
      about: Format.quantity(quantity),
      group: groupOf(quantity),
    }));
    const split = new Map();
    quantities.forEach((quantity, index) => {
      const slash = quantity.name.indexOf('/');
      if (slash < 0 || !quantity.element) return;
      const key = JSON.stringify([quantity.name.slice(0, slash), quantity.element, quantity.unit]);
      split.set(key, [...(split.get(key) || []), index]);
    });
    for (const [key, indices] of split) {
      if (indices.length < 2) continue;
      const [name, element, unit] = JSON.parse(key),
        about = Format.about(`${Format.words(name)} by term, ${element}`, Format.unit(unit));
      drawn.push({ id: `${name} by term ${element}`, indices, group: 'split by term', about });
    }
    for (const point of this.points) {
      for (const profile of (point.details || Live.known(point) || { profiles: [] }).profiles) {
        if (drawn.some((one) => one.id === profile.name)) continue;
        const about = Format.quantity({ ...profile, element: '' });
        const unitAlong = Format.unit(profile.axis.unit);
        drawn.push({ id: profile.name, indices: [], isCurve: true, about, unitAlong, group: 'along an axis' });
      }
    }
    const order = ['target', 'measured', 'along an axis', 'split by term', 'components', 'control variates'];
    return drawn.sort((a, b) => order.indexOf(a.group) - order.indexOf(b.group));
  }

  // Returns the kind of a point's mark: "jammed", "provisional" before it is decided, "decided" if it is converged or
  // complete, otherwise "undecided".
  static kind(point) {
    if (point.endings.has_jammed) return 'jammed';
    if (!point.decided) return 'provisional';
    return /^(converged|complete)/.test(point.state) ? 'decided' : 'undecided';
  }

  // True if the point has a number. At a jammed point a mean over half of its seeds or fewer does not count, because it
  // is that of the seeds that happened to flow.
  static isKnown({ endings }, estimate) {
    if (!estimate || !Format.isNumber(estimate[0])) return false;
    return !endings.has_jammed || 2 * estimate[3] > endings.ended;
  }

  nameOf(parameter, i) {
    const { about, cells, numeric } = parameter,
      cell = numeric ? Format.plain(cells[i]) : cells[i];
    const name = about.symbol.length ? about.symbol : Format.parts(about.words);
    return [...name, ...Format.parts(` = ${cell}`)];
  }

  // Returns the choice of one more quantity in the same frame.
  static with(choice, other) {
    return {
      ...choice,
      id: `${choice.id} and ${other.id}`,
      indices: [...choice.indices, ...other.indices],
      about: { words: `${choice.about.words}; ${other.about.words}`, symbol: [], unit: choice.about.unit },
    };
  }

  // Returns the figure of a choice over `axis`, with a panel for each combination of values of `panelBy`. The numbers
  // decide whether scales are logarithmic, unless log.x or log.y is given. `scale.x` and `scale.y` are of Derived.scales(),
  // or absent.
  figure(choice, axis, panelBy, log = {}, stacked = false, scale = {}) {
    const { quantities } = this.data,
      panels = new Map(),
      series = new Map(),
      rows = [],
      kinds = new Set();
    const others = this.others(axis).filter((one) => !panelBy.includes(one)),
      terms = choice.indices.length > 1;
    const joined = (list) => list.flatMap((parts, i) => [...(i ? Format.parts(', ') : []), ...parts]);
    const term = (index) =>
      choice.group === 'split by term'
        ? Format.words(quantities[index].name.split('/').slice(1).join('/'))
        : Format.quantity(quantities[index]).words;
    const along = (x, i) => (scale.x ? x * scale.x.factors[i] : x);
    let absent = 0;
    this.points.forEach((point, i) => {
      for (const index of choice.indices) {
        const { endings } = point,
          known = Sweep.isKnown(point, point.estimates[index]);
        if (!known && !endings.has_jammed) {
          absent += 1;
          continue;
        }
        const factor = scale.y ? scale.y.factors[i] : 1,
          scaled = (value) => (Format.isNumber(value) ? factor * value : value),
          measured = known ? point.estimates[index] : [null, null, null, endings.ended],
          [y, error, half] = measured.slice(0, 3).map(scaled),
          count = measured[3],
          own = point.curve[quantities[index].path],
          curve = own && Object.fromEntries(Object.entries(own).map(([name, value]) => [name, scaled(value)])),
          kind = Sweep.kind(point),
          { path } = quantities[index];
        const number = known ? Format.withError(y, half) : 'no number',
          state = point.state + (endings.has_jammed ? `, ${endings.jammed} of ${endings.ended} jammed` : '');
        const order = panelBy.map((one) => one.values.indexOf(one.cells[i])),
          key = JSON.stringify(order);
        if (!panels.has(key)) {
          const title = joined(panelBy.map((one) => this.nameOf(one, i)));
          panels.set(key, { title, order, marks: [] });
        }
        const named = others.map((one) => this.nameOf(one, i)),
          name = joined(terms ? [Format.parts(term(index)), ...named] : named),
          id = JSON.stringify(name);
        if (!series.has(id)) series.set(id, { series: series.size, name });
        const x = axis.numeric ? along(axis.cells[i], i) : axis.values.indexOf(axis.cells[i]);
        panels.get(key).marks.push({
          series: series.get(id).series,
          x,
          y,
          half,
          factor,
          allowed: scaled(point.good_enough[path]),
          curve,
          kind,
          point: i,
          text: `${point.label}${terms ? `, ${term(index)}` : ''}: ${number} (${Format.counted(count, 'seed')}, ${state})`,
        });
        kinds.add(kind);
        const shown = path + (scale.y ? scale.y.text : '');
        const row = [point.label, ...this.parameters.map((one) => one.cells[i]), shown, y, error, half, count];
        rows.push([...row, endings.has_jammed ? `${point.state}, jammed` : point.state]);
      }
    });
    const inOrder = (a, b) =>
      a.order.map((place, i) => place - b.order[i]).find((difference) => difference !== 0) || 0;
    const list = [...panels.values()].sort(inOrder);
    const marks = list.flatMap((panel) => panel.marks);
    const scales = {
      x: axis.numeric && (log.x ?? isLogarithmic(scale.x ? [...new Set(axis.cells.map(along))] : axis.values)),
      y: !stacked && (log.y ?? isLogarithmic(Chart.reached(list, false))),
    };
    const total = stacked ? choice.indices.findIndex((index) => quantities[index].name.endsWith('/total')) : -1;
    if (stacked) this.addControl(list, total, series, quantities[choice.indices[total]].path);
    for (const panel of list) {
      if (stacked) Sweep.stack(panel, total, scales.x);
      else Sweep.connect(panel, series.size);
    }
    const hidden = marks.filter((mark) => !Chart.isVisible(mark, scales.x, scales.y)).length;
    const notes = [];
    if (hidden)
      notes.push(`A logarithmic axis leaves out numbers that are not positive, which are ${hidden} here.`);
    if (absent) notes.push(`Numbers that are not measured yet are left out: ${Format.counted(absent, 'number')}.`);
    return {
      name: `${this.data.campaign} ${choice.id} over ${axis.about.words}`,
      panels: list,
      notes,
      pick: true,
      x: { about: Derived.scaled(axis.about, scale.x), log: scales.x, categories: axis.numeric ? null : axis.values },
      y: { about: Derived.scaled(choice.about, scale.y), log: scales.y },
      legend:
        series.size > 1
          ? [...series.values()].map((one) => (stacked && one.series !== total ? { ...one, kind: 'column' } : one))
          : [],
      kinds: [...kinds],
      hasBand: marks.some((mark) => mark.curve || Format.isNumber(mark.allowed)),
      bandName: marks.some((mark) => mark.curve) ? 'band of the curve' : 'tolerance',
      table: {
        columns: ['label', ...this.parameters.map((one) => one.pointer || 'point'), 'quantity', 'mean', 'standard_error',
          'half_width', 'count', 'state'],
        rows,
      },
    };
  }

  // Returns the parameters that vary, without those that follow from one of the others.
  distinguishing() {
    const varying = this.parameters.filter((one) => one.values.length > 1),
      found = [];
    for (const one of varying) {
      if (found.some((other) => this.isInStep(one, other))) continue;
      found.splice(0, found.length, ...found.filter((other) => !this.isInStep(other, one)), one);
    }
    return found;
  }

  // Returns the figure of a quantity along its own axis, as over_axis() of drawing.py makes it: a curve for each point
  // whose details are known, with shades instead of colours if they are many and in an order.
  curves(choice, panelBy, log = {}, scale = {}) {
    const by = this.distinguishing(),
      isMany = this.points.length > Svg.colours,
      isShaded = isMany && by.length === 1 && by[0].numeric,
      fewest = (best, one) => (one.values.length < best.values.length ? one : best),
      panelled = panelBy || (isMany && by.length > 1 ? [by.reduce(fewest)] : []),
      named = by.filter((one) => !panelled.includes(one)),
      joined = (parameters, i) =>
        parameters.flatMap((one, at) => [...(at ? Format.parts(', ') : []), ...this.nameOf(one, i)]);
    const order = this.points.map((_, i) => i);
    if (isShaded) order.sort((a, b) => by[0].cells[a] - by[0].cells[b]);
    const panels = new Map(),
      series = new Map(),
      kinds = new Set(),
      rows = [];
    let axis = null,
      absent = 0,
      seeds = null;
    for (const i of order) {
      const point = this.points[i],
        details = point.details || Live.details(point),
        profile = details && details.profiles.find((one) => one.name === choice.id),
        kind = Sweep.kind(point),
        isKnown = profile && (kind !== 'jammed' || 2 * details.of > point.endings.ended);
      if (!isKnown && kind !== 'jammed') {
        absent += 1;
        continue;
      }
      if (profile) axis = axis || profile.axis;
      if (isKnown && (!seeds || details.of - details.seeds > seeds.of - seeds.seeds)) seeds = details;
      const name = joined(named, i),
        id = JSON.stringify(name),
        title = joined(panelled, i),
        key = JSON.stringify(title);
      if (!series.has(id)) series.set(id, { series: series.size, name, kind: 'line' });
      const own = series.get(id);
      if (isShaded) own.shade = order.indexOf(i) / (order.length - 1);
      const look = isShaded ? { series: own.series, shade: own.shade } : { series: own.series };
      if (!panels.has(key)) panels.set(key, { title, marks: [], lines: [], bands: [] });
      const panel = panels.get(key),
        empty = { axis: { values: [] }, mean: [], half_width: [], standard_error: [] },
        times = (of, value) => (of && Format.isNumber(value) ? value * of.factors[i] : value),
        scaled = (of, values) => values.map((value) => times(of, value)),
        whole = isKnown ? profile : empty,
        drawn = {
          axis: { values: scaled(scale.x, whole.axis.values) },
          mean: scaled(scale.y, whole.mean),
          half_width: scaled(scale.y, whole.half_width),
          standard_error: scaled(scale.y, whole.standard_error),
        },
        curve = DetailsView.curve(drawn.axis.values, drawn);
      for (const line of curve.lines)
        panel.lines.push({ ...line, ...look, style: kind === 'provisional' ? 'dashed' : 'line' });
      for (const band of curve.bands) panel.bands.push({ ...band, ...look });
      if (kind === 'jammed') {
        const [x, y] = curve.lines[0].places[curve.lines[0].places.length - 1] || [null, null];
        panel.marks.push({ ...look, x, y, half: null, kind, point: i, text: `${point.label}: jammed` });
      }
      if (kind === 'jammed' || kind === 'provisional') kinds.add(kind);
      drawn.axis.values.forEach((x, k) => {
        const cells = this.parameters.map((one) => one.cells[i]);
        const shown = choice.id + (scale.y ? scale.y.text : '');
        rows.push([point.label, ...cells, shown, x, drawn.mean[k], drawn.standard_error[k], drawn.half_width[k]]);
      });
    }
    const list = [...panels.values()],
      xs = list.flatMap((panel) => panel.lines.flatMap((line) => line.places.map(([x]) => x)));
    const scales = {
      x: log.x ?? isLogarithmic([...new Set(xs)]),
      y: log.y ?? isLogarithmic(Chart.reached(list, false)),
    };
    for (const panel of list) Sweep.placeJams(panel.marks, xs, scales.x);
    const names = [...series.values()],
      step = isShaded ? Math.ceil((names.length - 1) / 9) : 1;
    return {
      name: `${this.data.campaign} ${choice.id}`,
      panels: list,
      notes: absent ? [`Points without this quantity yet are left out: ${absent}.`] : [],
      x: {
        about: Derived.scaled(axis ? Format.about(Format.words(axis.name), Format.unit(axis.unit)) : Format.about(''), scale.x),
        log: scales.x,
      },
      y: { about: Derived.scaled(choice.about, scale.y), log: scales.y },
      legend: names.length > 1 ? names.filter((_, i) => i % step === 0) : [],
      kinds: [...kinds],
      hasBand: list.some((panel) => panel.bands.length),
      bandName: 'interval of the mean',
      caption: seeds && seeds.seeds < seeds.of ? `Means of ${DetailsView.seeds(seeds)} of a point, or fewer.` : '',
      table: {
        columns: ['label', ...this.parameters.map((one) => one.pointer || 'point'), 'quantity', axis ? axis.name : 'x',
          'mean', 'standard_error', 'half_width'],
        rows,
      },
    };
  }

  // Places jammed points without a curve side by side at the right end of the numbers `xs`.
  static placeJams(marks, xs, log) {
    const along = xs.filter((x) => !log || x > 0).map((x) => (log ? Math.log10(x) : x)),
      [low, high] = along.length ? [Math.min(...along), Math.max(...along)] : [0, 1];
    marks
      .filter((mark) => mark.y === null)
      .forEach((mark, at) => {
        const x = high - (at * (high - low)) / 30;
        mark.x = log ? 10 ** x : x;
      });
  }

  // Adds the control variate as a part of a stacked sum: the mean of the sum includes it, those of the parts do not.
  addControl(panels, total, series, path) {
    const place = Math.max(series.size, 6); // a colour that differs from the first ones
    for (const { marks } of panels) {
      for (const mark of marks.filter((one) => one.series === total && Format.isNumber(one.y))) {
        const plain = this.points[mark.point].plain[path];
        if (!plain || plain[0] * mark.factor === mark.y) continue;
        const y = mark.y - plain[0] * mark.factor,
          text = `${this.points[mark.point].label}, control variate: ${Format.rough(y)}`;
        marks.push({ ...mark, series: place, y, half: null, text });
        series.set('control', { series: place, name: Format.parts('control variate') });
      }
    }
  }

  // True if the choice is a sum and all of its parts, at every point and within rounding, so that these can be stacked.
  isSum(choice) {
    const { quantities } = this.data,
      total = choice.indices.find((index) => quantities[index].name.endsWith('/total'));
    if (total === undefined || choice.indices.length < 3) return false;
    const mean = (point, index) => (point.estimates[index] ? point.estimates[index][0] : null);
    return this.points.every((point) => {
      const parts = choice.indices.filter((index) => index !== total).map((index) => mean(point, index));
      if (!Format.isNumber(mean(point, total))) return true;
      const [sum] = point.plain[quantities[total].path] || [mean(point, total)];
      const size = parts.reduce((all, part) => all + Math.abs(part), 0);
      return Math.abs(parts.reduce((all, part) => all + part, 0) - sum) <= 1e-6 * size;
    });
  }

  // True if no two points of a panel are at the same place on the axis.
  isAlone(axis, panelBy) {
    const seen = new Set(this.points.map((_, i) => JSON.stringify([axis, ...panelBy].map((one) => one.cells[i]))));
    return seen.size === this.points.length;
  }

  // Turns the parts into stacked boxes, negative ones below zero. The sum remains a mark with its bar.
  static stack(panel, total, log) {
    const parts = panel.marks.filter((mark) => mark.series !== total && Format.isNumber(mark.y)),
      along = (x) => (log ? Math.log10(x) : x),
      xs = [...new Set(panel.marks.map((mark) => mark.x))].filter((x) => !log || x > 0).map(along).sort((a, b) => a - b);
    const gaps = xs.slice(1).map((x, i) => x - xs[i]),
      gap = gaps.length ? Math.min(...gaps) : log ? 0.3 : 0.1 * Math.abs(xs[0]) || 1;
    const ends = new Map();
    panel.columns = [];
    for (const mark of parts) {
      if (log && !(mark.x > 0)) continue;
      const [below, above] = ends.get(mark.x) || [0, 0],
        places = [-1, 1].map((side) => along(mark.x) + 0.3 * side * gap).map((x) => (log ? 10 ** x : x));
      const [low, high] = mark.y < 0 ? [below + mark.y, below] : [above, above + mark.y];
      ends.set(mark.x, mark.y < 0 ? [low, above] : [below, high]);
      panel.columns.push({ from: places[0], to: places[1], low, high, series: mark.series, text: mark.text });
    }
    panel.marks = panel.marks.filter((mark) => mark.series === total);
    panel.levels = [{ value: 0, across: true, series: 7, style: 'zero' }];
    [panel.lines, panel.bands] = [[], []];
  }

  // Adds lines that guide the eye through each series, and the tolerance as a band around it.
  static connect(panel, series) {
    [panel.lines, panel.bands] = [[], []];
    for (let place = 0; place < series; ++place) {
      const marks = panel.marks
        .filter((mark) => mark.series === place && mark.kind !== 'jammed')
        .sort((a, b) => a.x - b.x);
      const places = marks.map((mark) => [mark.x, mark.y]);
      if (places.length > 1) panel.lines.push({ series: place, style: 'guide', places });
      const curved = marks.filter((mark) => mark.curve).map((mark) => [mark.x, mark.curve.low, mark.curve.high]),
        allowed = marks
          .filter((mark) => Format.isNumber(mark.allowed))
          .map((mark) => [mark.x, mark.y - mark.allowed, mark.y + mark.allowed]);
      const banded = panel.marks.some((mark) => mark.curve) ? curved : allowed;
      if (banded.length) panel.bands.push({ series: place, places: banded });
    }
  }
}

// The chart over the sweep, with its controls.
class SweepView {
  constructor(host, onPick) {
    const ids = ['quantity', 'second', 'axis', 'panels', 'scale-y', 'scale-x'];
    [this.quantity, this.second, this.axis, this.panels, this.scaleY, this.scaleX] = ids.map((id) => {
      const select = Page.select([], () => (id === 'panels' ? this.draw() : this.renew()));
      select.id = id;
      return select;
    });
    [this.logX, this.logY, this.stacked] = ['log-x', 'log-y', 'stacked'].map((id) =>
      Page.element('input', { type: 'checkbox', id }),
    );
    for (const box of [this.logX, this.logY])
      box.addEventListener('change', () => {
        this.setByHand = true;
        this.draw();
      });
    this.stacked.checked = true;
    this.stacked.addEventListener('change', () => this.draw());
    const switched = (box, text) => Page.element('label', { className: 'switch' }, '', box, text);
    this.stacking = switched(this.stacked, 'stacked');
    const scales = Page.element('span', {}, switched(this.logX, 'log x'), switched(this.logY, 'log y'), this.stacking);
    const controls = Page.element(
      'div',
      { className: 'controls' },
      Page.labelled('Quantity', this.quantity),
      (this.secondLabel = Page.labelled('and', this.second)),
      (this.scaleYLabel = Page.labelled('in', this.scaleY)),
      Page.labelled('Over', this.axis),
      (this.scaleXLabel = Page.labelled('in', this.scaleX)),
      Page.labelled('Panels', this.panels),
      scales,
    );
    this.chart = new Chart(onPick);
    host.append(Page.heading('h2', 'Results'), controls, this.chart.host);
    this.setByHand = false;
  }

  show(data) {
    this.data = data;
    this.sweep = new Sweep(data);
    this.choices = this.sweep.choices();
    const { sweep } = this,
      isFirst = !this.axis.options.length,
      option = (one, i) => [String(i), Format.option(one.about)];
    const quantities = this.choices.map((one, i) => [...option(one, i), one.group]);
    Page.refill(this.quantity, quantities);
    const derived = (one, i) => [...option(one, i), i < sweep.parameters.length ? 'swept' : 'follows from the scene'];
    Page.refill(this.axis, sweep.axes.length > sweep.parameters.length ? sweep.axes.map(derived) : sweep.axes.map(option));
    Page.refill(this.panels, [['usual', 'automatic'], ['none', 'none'], ...sweep.parameters.map(option)]);
    if (isFirst) this.axis.value = String(sweep.parameters.indexOf(sweep.usual));
    this.draw();
  }

  // Draws another quantity or axis; the numbers decide again whether scales are logarithmic.
  renew() {
    this.setByHand = false;
    this.draw();
  }

  // Returns the chosen quantity, with the second one if there is one; nothing without a quantity.
  chosen() {
    const choice = this.choices[Number(this.quantity.value)],
      isSingle = choice && choice.indices.length === 1;
    const fitting = isSingle
      ? this.choices.filter((one) => one !== choice && one.indices.length === 1 && one.about.unit === choice.about.unit)
      : [];
    Page.refill(this.second, [['', 'nothing else'], ...fitting.map((one) => [one.id, Format.option(one.about)])]);
    this.secondLabel.hidden = fitting.length === 0;
    const other = fitting.find((one) => one.id === this.second.value);
    return other ? Sweep.with(choice, other) : choice;
  }

  // Returns the chosen scales of numbers in these units, and offers those that there are.
  scale(unitY, unitX) {
    const found = {};
    for (const [name, select, label, unit] of [
      ['y', this.scaleY, this.scaleYLabel, unitY],
      ['x', this.scaleX, this.scaleXLabel, unitX],
    ]) {
      const scales = this.sweep.derived.scales(unit || '');
      Page.refill(select, [['', unit || 'its unit'], ...scales.map((one) => [one.id, one.option])]);
      label.hidden = scales.length === 0;
      found[name] = scales.find((one) => one.id === select.value);
    }
    return found;
  }

  draw() {
    const { sweep } = this,
      axis = sweep.axes[Number(this.axis.value)];
    const choice = this.chosen();
    const chosen = sweep.parameters[Number(this.panels.value)],
      by =
        this.panels.value === 'usual'
          ? sweep.usualPanels(axis, choice ? choice.indices.length : 1)
          : [chosen].filter((one) => one && one !== axis);
    if (!choice) {
      this.chart.show({ panels: [] });
      return;
    }
    this.axis.disabled = Boolean(choice.isCurve);
    if (choice.isCurve) {
      this.drawCurves(choice);
      return;
    }
    const canStack = sweep.isSum(choice) && sweep.isAlone(axis, by),
      stacked = canStack && this.stacked.checked;
    this.stacking.hidden = choice.indices.length < 2;
    this.stacked.disabled = !canStack;
    const log = this.setByHand ? { x: this.logX.checked, y: this.logY.checked } : {},
      scale = this.scale(choice.about.unit, axis.numeric ? axis.about.unit : ''),
      figure = sweep.figure(choice, axis, by, log, stacked, scale);
    this.logY.disabled = stacked;
    this.logX.checked = figure.x.log;
    this.logY.checked = figure.y.log;
    this.logX.disabled = !axis.numeric;
    const bars = `Bars are ${Format.rough(100 * this.data.target.confidence)} % confidence intervals`;
    figure.caption =
      (stacked ? `${bars} of the sum; negative parts are stacked below zero.` : `${bars}; lines only guide the eye.`) +
      (figure.hasBand ? ' Bands: the tolerance around each mean.' : '') +
      (figure.kinds.includes('provisional')
        ? ' Provisional: the point is not decided yet, and its number may still change.'
        : '');
    this.chart.show(figure);
  }

  // Draws a quantity along its own axis. Panels are chosen as for numbers.
  drawCurves(choice) {
    const { sweep } = this,
      chosen = sweep.parameters[Number(this.panels.value)],
      by = this.panels.value === 'usual' ? null : [chosen].filter(Boolean),
      log = this.setByHand ? { x: this.logX.checked, y: this.logY.checked } : {},
      figure = sweep.curves(choice, by, log, this.scale(choice.about.unit, choice.unitAlong));
    this.stacking.hidden = true;
    this.logX.disabled = this.logY.disabled = false;
    [this.logX.checked, this.logY.checked] = [figure.x.log, figure.y.log];
    const confidence = Format.rough(100 * this.data.target.confidence);
    figure.caption = `A curve for each point; bands are ${confidence} % confidence intervals. ${figure.caption}`;
    this.chart.show(figure);
  }
}
