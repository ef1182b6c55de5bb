
// What the sweep varies, and the figure of a measured quantity over one of its parameters. Pure: no document is touched.
class Sweep {
  constructor(data) {
    this.data = data;
    this.points = data.points;
    this.parameters = data.parameters.map(parameter => this.column(parameter));
    if (this.parameters.length === 0) {
      this.parameters = [{ pointer: '', about: { words: 'point', symbol: [], unit: '' }, numeric: false,
        values: this.points.map(point => point.label), cells: this.points.map(point => point.label) }];
    }
    const first = this.parameters.filter(one => one.numeric && one.values.length > 1)
      .reduce((best, one) => !best || one.values.length > best.values.length ? one : best, null);
    this.usual = first || this.parameters.find(one => one.values.length > 1) || this.parameters[0];
  }

  // One parameter: the cell of each point as text, its values in order, each once.
  column(parameter) {
    const raw = this.points.map(point => point.settings[parameter.pointer]);
    const numeric = raw.every(Format.isNumber);
    const texts = [...new Set(raw.map(value => JSON.stringify(value)))];
    const long = text => text !== undefined && text.length > 26 ? `#${texts.indexOf(text) + 1}` : null;
    const cells = raw.map(value => numeric ? value : value === undefined ? '–' : long(JSON.stringify(value)) || Format.value(value));
    const values = [...new Set(cells)];
    if (numeric) values.sort((a, b) => a - b);
    return { pointer: parameter.pointer, meaning: parameter.meaning, about: Format.parameter(parameter), numeric, cells, values };
  }

  // Whether `axis` says what `other` is.
  isInStep(other, axis) {
    const partner = new Map();
    return this.points.every((_, i) => {
      const known = partner.get(axis.cells[i]);
      if (known === undefined) partner.set(axis.cells[i], other.cells[i]);
      return known === undefined || known === other.cells[i];
    });
  }

  others(axis) { return this.parameters.filter(one => one !== axis && one.values.length > 1 && !this.isInStep(one, axis)); }

  // The usual parameter of panels: none while curves are few enough to be told apart, or else the one with fewest values.
  usualPanels(axis, perPoint = 1) {
    const others = this.others(axis), curves = others.reduce((product, one) => product * one.values.length, perPoint);
    if (curves <= Svg.colours && others.length < 2) return perPoint > 1 && others.length ? others[0] : null;
    return others.reduce((best, one) => !best || one.values.length < best.values.length ? one : best, null);
  }

  // What may be drawn: each measured quantity, the target first, then sums that are split by term (names with the same
  // beginning and the same elements, such as stress/...).
  choices() {
    const { quantities, target } = this.data, path = target.observable.replace(/^\//, '');
    const drawn = quantities.map((quantity, index) => ({ id: quantity.path, indices: [index], about: Format.quantity(quantity),
      group: quantity.path === path || (target.also || []).some(one => one.observable.replace(/^\//, '') === quantity.path) ?
        'target' : quantity.name.startsWith('control_variates/') ? 'control variates' : quantity.element ? 'components' : 'measured' }));
    const split = new Map();
    quantities.forEach((quantity, index) => {
      const slash = quantity.name.indexOf('/');
      if (slash < 0 || !quantity.element) return;
      const key = `${quantity.name.slice(0, slash)}/*/${quantity.element}`;
      split.set(key, [...(split.get(key) || []), index]);
    });
    for (const [id, indices] of split) {
      if (indices.length < 2) continue;
      const [name, , element] = id.split('/'), unit = Format.unit(quantities[indices[0]].unit);
      drawn.push({ id, indices, group: 'split by term',
        about: { words: `${Format.words(name)} by term, ${element}`, symbol: Format.symbol(`sigma_${element}`), unit } });
    }
    const order = ['target', 'measured', 'split by term', 'components', 'control variates'];
    return drawn.sort((a, b) => order.indexOf(a.group) - order.indexOf(b.group));
  }

  // How sure the number of a point is: of a look that decides, of one that does not, or of the seeds so far.
  static kind(point) {
    if (!point.decided) return 'provisional';
    return point.standing.startsWith('converged') ? 'decided' : 'undecided';
  }

  nameOf(parameter, i) {
    const { about } = parameter, cell = parameter.numeric ? Format.plain(parameter.cells[i]) : parameter.cells[i];
    return [...(about.symbol.length ? about.symbol : [{ text: about.words, level: 0 }]), { text: ` = ${cell}`, level: 0 }];
  }

  // The figure of a choice over `axis`, with a panel for each value of `panelBy`, which may be null. Scales are those that
  // fit unless log.x or log.y is given.
  figure(choice, axis, panelBy, log = {}) {
    const { quantities } = this.data, panels = new Map(), series = new Map(), rows = [];
    const others = this.others(axis).filter(one => one !== panelBy), kinds = new Set();
    let absent = 0;
    const joined = list => list.reduce((all, parts) => [...all, ...(all.length ? [{ text: ', ', level: 0 }] : []), ...parts], []);
    this.points.forEach((point, i) => {
      for (const index of choice.indices) {
        const estimate = point.estimates[index];
        if (!estimate || !Format.isNumber(estimate[0])) { absent += 1; continue; }
        const [y, error, half, count] = estimate, kind = Sweep.kind(point), terms = choice.indices.length > 1;
        const title = panelBy ? this.nameOf(panelBy, i) : [], key = panelBy ? String(panelBy.cells[i]) : '';
        if (!panels.has(key)) panels.set(key, { title, order: panelBy ? panelBy.values.indexOf(panelBy.cells[i]) : 0, marks: [] });
        const name = joined([...(terms ? [[{ text: Format.words(quantities[index].name.split('/').slice(1).join('/')), level: 0 }]] : []),
          ...others.map(one => this.nameOf(one, i))]);
        const id = JSON.stringify(name);
        if (!series.has(id)) series.set(id, { place: series.size, name });
        const allowed = point.good_enough[quantities[index].path];
        const x = axis.numeric ? axis.cells[i] : axis.values.indexOf(axis.cells[i]);
        panels.get(key).marks.push({ series: series.get(id).place, x, y, half, allowed, kind, point: i,
          text: `${point.label}: ${Format.withError(y, half)} (${Format.counted(count, 'seed')}, ${point.standing})` });
        kinds.add(kind);
        rows.push([point.label, ...this.parameters.map(one => one.numeric ? one.cells[i] : String(one.cells[i])),
          quantities[index].path, y, error, half, count, point.standing]);
      }
    });
    const list = [...panels.values()].sort((a, b) => a.order - b.order);
    for (const panel of list) Sweep.connect(panel, series.size);
    const marks = list.flatMap(panel => panel.marks);
    const ends = marks.flatMap(mark => mark.kind === 'provisional' || !Format.isNumber(mark.half) ? [mark.y] :
      [mark.y - mark.half, mark.y + mark.half]);
    const notes = [];
    const scales = { x: log.x ?? (axis.numeric && isLogarithmic(axis.values)), y: log.y ?? isLogarithmic(ends) };
    if (!axis.numeric) scales.x = false;
    const hidden = marks.filter(mark => scales.y && !(mark.y > 0) || scales.x && !(mark.x > 0)).length;
    if (hidden) notes.push(`${Format.counted(hidden, 'number')} that ${hidden === 1 ? 'is' : 'are'} not positive cannot be drawn on a logarithmic axis.`);
    if (absent) notes.push(`${Format.counted(absent, 'number')} that ${absent === 1 ? 'does' : 'do'} not exist yet ${absent === 1 ? 'is' : 'are'} left out.`);
    return {
      name: `${this.data.campaign} ${choice.id} over ${axis.about.words}`, panels: list, notes, pick: true,
      x: { about: axis.about, log: scales.x, categories: axis.numeric ? null : axis.values.map(String) },
      y: { about: choice.about, log: scales.y },
      legend: series.size > 1 ? [...series.values()].map(one => ({ series: one.place, name: one.name })) : [],
      kinds: [...kinds], hasBand: marks.some(mark => Format.isNumber(mark.allowed)),
      table: { columns: ['label', ...this.parameters.map(one => one.pointer || 'point'), 'quantity', 'mean', 'standard_error', 'half_width',
        'count', 'standing'], rows },
    };
  }

  // Lines that guide the eye through each series, and the tolerance as a band around it.
  static connect(panel, series) {
    [panel.lines, panel.bands] = [[], []];
    for (let place = 0; place < series; ++place) {
      const marks = panel.marks.filter(mark => mark.series === place).sort((a, b) => a.x - b.x);
      if (marks.length > 1) panel.lines.push({ series: place, style: 'guide', places: marks.map(mark => [mark.x, mark.y]) });
      const banded = marks.filter(mark => Format.isNumber(mark.allowed));
      if (banded.length) panel.bands.push({ series: place, places: banded.map(mark => [mark.x, mark.y - mark.allowed, mark.y + mark.allowed]) });
    }
  }
}
