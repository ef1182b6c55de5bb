// A figure as SVG, with links that save it.
//
//   figure   {name, x, y: {about, log, categories}, panels: [{title, marks, lines, bands, columns, levels}], legend,
//            kinds, hasBand, notes, caption, empty, table, pick, height}
//   marks    {series, x, y, half, kind, point, text}; y is null for a point that has jammed and has no number
//   lines    {series, style, places: [x, y]}; lines, bands and legend may have a shade from 0 to 1 for a colour
//   bands    {series, places: [x, low, high]}
//   columns  boxes: {from, to, low, high, series, text}
//   levels   {value, across}
//   legend   {series, name, kind}; kind: "column" for a box, "line", or that of a mark
class Chart {
  // `onPick(point)` is called when a mark of that point is chosen.
  constructor(onPick = null) {
    Object.assign(this, { host: Page.element('figure'), onPick, figure: null, chosen: null, width: 0 });
    new ResizeObserver(() => {
      if (this.figure && Math.abs(this.host.clientWidth - this.width) > 2) this.draw();
    }).observe(this.host);
  }

  // Draws the figure, unless it is the one shown.
  show(figure) {
    const key = JSON.stringify(figure);
    if (this.shown === key && this.host.firstChild) return;
    this.shown = key;
    this.figure = figure;
    this.panels = figure.panels.map((panel) => ({ lines: [], bands: [], columns: [], levels: [], title: [], ...panel }));
    this.draw();
  }

  choose(point) {
    if (this.chosen === point) return;
    this.chosen = point;
    if (this.figure && this.figure.pick) this.draw();
  }

  draw() {
    const { figure, host } = this,
      hadFocus = host.contains(document.activeElement) && document.activeElement.tagName === 'svg';
    this.width = host.clientWidth;
    const said = [figure.caption, ...(figure.notes || [])].filter(Boolean).join(' '),
      isDrawn = ({ marks, lines, columns }) =>
        marks.length + columns.length > 0 || lines.some((line) => line.places.length > 1);
    host.replaceChildren();
    if (!this.panels.some(isDrawn)) {
      host.append(Page.element('figcaption', {}, figure.empty || 'There is nothing to draw yet.'));
      return;
    }
    const svg = this.svg(Math.min(1000, Math.max(280, this.width || 720)));
    host.append(
      svg,
      Page.element('figcaption', {}, said),
      Saving.links(
        Saving.link('CSV', `${figure.name}.csv`, 'text/csv', Saving.csv(figure.table)),
        Saving.link('SVG', `${figure.name}.svg`, 'image/svg+xml', Svg.standalone(svg)),
        Saving.link('matplotlib', `${figure.name}.py`, 'text/x-python', Saving.script(figure)),
      ),
    );
    if (hadFocus) svg.focus();
  }

  // Returns the numbers of a mark that the axis must show. Bars of provisional numbers may be enormous and are left out.
  static ends({ y, half, kind }) {
    if (!Format.isNumber(y)) return [];
    return kind !== 'provisional' && Format.isNumber(half) ? [y - half, y + half] : [y];
  }

  // True for a number of a point that flows whose interval is narrower than the number itself.
  static isCertain({ y, half, kind }) {
    return kind !== 'jammed' && Format.isNumber(half) && half < Math.abs(y);
  }

  // Returns the numbers along y that the frame must show. A number is uncertain if its point has jammed, or if its
  // interval is wider than the number itself. Uncertain numbers stretch the axis to ten times the others at most, and
  // those of curves a logarithmic axis to a tenth of the others.
  static reached(panels, log) {
    const factor = 10,
      usable = (numbers) => numbers.filter((number) => Format.isNumber(number) && (!log || number > 0)),
      marks = panels.flatMap((panel) => panel.marks.filter((mark) => Format.isNumber(mark.y))),
      places = panels.flatMap((panel) => (panel.bands || []).flatMap((band) => band.places)),
      isNarrow = ([, low, high]) => high - low < Math.abs(high + low),
      ends = ([, low, high]) => [low, high];
    const certain = usable([
      ...marks.filter(Chart.isCertain).flatMap(Chart.ends),
      ...places.filter(isNarrow).flatMap(ends),
      ...panels.flatMap((panel) => (panel.columns || []).flatMap((column) => [column.low, column.high])),
    ]);
    let uncertain = usable(marks.filter((mark) => !Chart.isCertain(mark)).flatMap((mark) => [mark.y, ...Chart.ends(mark)])),
      along = usable([
        ...places.filter((place) => !isNarrow(place)).flatMap(ends),
        ...panels.flatMap(({ lines = [] }) =>
          lines.filter((line) => line.style !== 'guide').flatMap((line) => line.places.map(([, y]) => y)),
        ),
      ]);
    const sizes = certain.map(Math.abs),
      most = factor * Math.max(...sizes, 0),
      least = log ? Math.min(...sizes) / factor : -Infinity;
    if (most > 0) {
      uncertain = uncertain.filter((y) => Math.abs(y) <= most);
      along = along.filter((y) => y >= least && Math.abs(y) <= most);
    }
    const levels = panels.flatMap((panel) => (panel.levels || []).filter((level) => level.across));
    return [...certain, ...uncertain, ...along, ...usable(levels.map((level) => level.value))];
  }

  // True if the axes can show the mark. A logarithmic axis shows positive numbers only; jammed points are at its edge.
  static isVisible({ x, y, kind }, isLogX, isLogY) {
    return (!isLogY || y > 0 || kind === 'jammed') && (!isLogX || x > 0);
  }

  // Returns the least and the largest number to be shown along x or y.
  range(direction) {
    const { log } = this.figure[direction],
      isX = direction === 'x';
    const numbers = !isX
      ? Chart.reached(this.panels, log)
      : this.panels.flatMap(({ marks, lines, bands, columns, levels }) => [
          ...marks.map((mark) => mark.x),
          ...[...lines, ...bands].flatMap((one) => one.places.map(([x]) => x)),
          ...columns.flatMap((column) => [column.from, column.to]),
          ...levels.filter((level) => !level.across).map((level) => level.value),
        ]);
    const usable = numbers.filter((number) => Format.isNumber(number) && (!log || number > 0));
    if (!usable.length) return log ? [1, 10] : [0, 1]; // only marks at the edge
    const low = usable.reduce((a, b) => Math.min(a, b), Infinity),
      high = usable.reduce((a, b) => Math.max(a, b), -Infinity);
    // A bar that reaches almost to zero is cut, because it would squeeze all others.
    const centres = this.panels.flatMap((panel) => panel.marks.map((mark) => mark.y)).filter((y) => y > 0);
    return [log && !isX && centres.length ? Math.max(low, Math.min(...centres) / 3) : low, high];
  }

  svg(width) {
    const { figure, panels } = this,
      count = panels.length;
    const columns = count === 1 ? 1 : Math.min(count, width >= 900 ? 3 : width >= 560 ? 2 : 1);
    const cell = width / columns,
      height = figure.height || Math.max(230, Math.min(430, cell * 0.58)),
      above = panels.some((panel) => panel.title.length) ? 22 : 0,
      legend = this.legend(width),
      bottom = Math.ceil(count / columns) * (height + above);
    const label = [figure.y, figure.x].map(({ about }) => Format.plainText(Format.title(about))).join(' over ');
    const svg = Svg.element('svg', {
      class: 'chart',
      viewBox: `0 0 ${Svg.number(width)} ${Svg.number(bottom + legend.height)}`,
      role: 'img',
      'aria-label': label,
    });
    const ranges = { x: this.range('x'), y: this.range('y') };
    panels.forEach((panel, i) => {
      const top = Math.floor(i / columns) * (height + above) + above;
      svg.append(this.panel(panel, (i % columns) * cell, top, cell, height, ranges));
    });
    legend.draw(svg, bottom);
    if (figure.pick && this.onPick) this.listen(svg);
    return svg;
  }

  // Returns an axis of the figure whose ticks are at least `spacing` pixels apart.
  axis(direction, [low, high], begin, end, spacing) {
    const { log, categories } = this.figure[direction],
      mostTicks = Math.max(3, Math.min(9, Math.floor(Math.abs(end - begin) / spacing)));
    return new Axis({ log, low, high, begin, end, mostTicks, categories });
  }

  panel(panel, left, top, width, height, ranges) {
    const { figure } = this,
      group = Svg.element('g');
    const frame = { right: left + width - 12, top: top + 8, bottom: top + height - 48, atEdge: new Map() };
    const y = this.axis('y', ranges.y, frame.bottom, frame.top, 36);
    // Wide numbers at the ticks need more room beside the title.
    const widest = y.categories ? 0 : Math.max(...y.ticks().map((tick) => Svg.width(tick.text)));
    frame.left = left + Math.max(66, 32 + widest);
    const x = this.axis('x', ranges.x, frame.left, frame.right, 58);
    this.frame(group, frame, x, y, panel, left, height, top);
    const visible = (mark) => Chart.isVisible(mark, figure.x.log, figure.y.log);
    for (const band of panel.bands) group.append(Chart.band(band, x, y));
    for (const column of panel.columns) group.append(Chart.box(column, x, y));
    for (const level of panel.levels) group.append(Chart.level(level, frame, x, y));
    for (const line of panel.lines) {
      const places = line.places
        .filter(([px, py]) => visible({ x: px, y: py }))
        .map(([px, py]) => [x.place(px), y.clamped(py)]);
      if (places.length > 1)
        group.append(Svg.shaded(Svg.path(`${line.style} s${line.series % Svg.colours}`, places), line, 'stroke'));
    }
    for (const mark of panel.marks) if (visible(mark)) group.append(this.mark(mark, x, y, frame, ranges.y));
    return group;
  }

  frame(group, frame, x, y, panel, left, height, top) {
    const { figure } = this,
      width = frame.right - frame.left,
      length = frame.bottom - frame.top;
    // Returns k if there is room for every k-th word.
    const every = ({ categories }, room, size) =>
      categories ? Math.max(1, Math.ceil((categories.length * size) / room)) : 1;
    x.ticks().forEach((tick, i) => {
      const place = x.place(tick.value);
      group.append(Svg.line('grid', place, frame.top, place, frame.bottom));
      if (i % every(x, width, 60) === 0)
        group.append(Svg.text(tick.text, { x: place, y: frame.bottom + 18, 'text-anchor': 'middle' }));
    });
    y.ticks().forEach((tick, i) => {
      const place = y.place(tick.value);
      group.append(Svg.line('grid', frame.left, place, frame.right, place));
      if (i % every(y, length, 15) === 0)
        group.append(Svg.text(tick.text, { x: frame.left - 7, y: place + 4.5, 'text-anchor': 'end' }));
    });
    const middle = (frame.left + frame.right) / 2,
      turned = `translate(${Svg.number(left + 15)} ${Svg.number((frame.top + frame.bottom) / 2)}) rotate(-90)`,
      title = (parts, place) => Svg.text(parts, { class: 'title', ...place, 'text-anchor': 'middle' });
    group.append(
      Svg.element('rect', { class: 'frame', x: frame.left, y: frame.top, width, height: length }),
      title(Format.title(figure.x.about), { x: middle, y: top + height - 10 }),
      title(Chart.fitting(figure.y.about, length), { transform: turned }),
    );
    if (panel.title.length) group.append(title(panel.title, { x: middle, y: top - 3 }));
  }

  // Returns a box, at least one pixel wide.
  static box(column, x, y) {
    const [from, to] = [x.place(column.from), x.place(column.to)].sort((a, b) => a - b),
      [high, low] = [y.clamped(column.low), y.clamped(column.high)].sort((a, b) => a - b);
    const box = Svg.element('rect', {
      class: `column s${column.series % Svg.colours}`,
      x: from,
      y: high,
      width: Math.max(1, to - from),
      height: low - high,
    });
    if (column.text) box.append(Svg.element('title', {}, column.text));
    return box;
  }

  // Returns the title, or the symbol and unit if the title is too long.
  static fitting(about, length) {
    const whole = Format.title(about);
    if (Svg.width(whole) <= length + 40 || !about.symbol.length) return whole;
    return Format.title({ words: '', symbol: about.symbol, unit: about.unit });
  }

  static band(band, x, y) {
    const pixels = band.places
      .map(([px, low, high]) => [x.place(px), y.clamped(low), y.clamped(high)])
      .sort((a, b) => a[0] - b[0]);
    if (pixels.length === 1) {
      const [place, low, high] = pixels[0];
      pixels.splice(0, 1, [place - 14, low, high], [place + 14, low, high]);
    }
    const outline = [...pixels.map(([px, , high]) => [px, high]), ...pixels.map(([px, low]) => [px, low]).reverse()];
    return Svg.shaded(Svg.path(`band s${band.series % Svg.colours}`, outline, true), band, 'fill');
  }

  static level(level, frame, x, y) {
    const place = level.across ? y.clamped(level.value) : x.clamped(level.value),
      style = `${level.style || 'dashed'} s${level.series || 0}`;
    return level.across
      ? Svg.line(style, frame.left, place, frame.right, place)
      : Svg.line(style, place, frame.top, place, frame.bottom);
  }

  // Returns the height of a mark, and the kind of its sign. A mark outside of the frame is at its edge, as a cross if its
  // point has jammed, otherwise as an arrow head. A jammed point without a number is at the upper edge.
  place(mark, y, frame, [low, high]) {
    const isAbove = !Format.isNumber(mark.y) || mark.y > high;
    if (!isAbove && mark.y >= low) return { at: y.place(mark.y), kind: mark.kind, inside: true };
    const kind = mark.kind === 'jammed' ? 'jammed' : isAbove ? 'above' : 'below',
      place = `${mark.x} ${isAbove}`,
      shift = 11 * (frame.atEdge.get(place) || 0); // further signs stand beside the first, towards the middle
    frame.atEdge.set(place, (frame.atEdge.get(place) || 0) + 1);
    return { at: isAbove ? frame.top + shift : frame.bottom - shift, kind, inside: false };
  }

  static group({ kind }, ...children) {
    return Svg.element('g', kind === 'provisional' ? { class: 'provisional' } : {}, ...children);
  }

  mark(mark, x, y, frame, range) {
    const group = Chart.group(mark);
    const px = x.place(mark.x),
      { at: py, kind, inside } = this.place(mark, y, frame, range),
      style = `bar s${mark.series % Svg.colours}`,
      cap = 4;
    if (mark.text) group.append(Svg.element('title', {}, mark.text));
    if (Format.isNumber(mark.half) && inside) {
      for (const end of [mark.y - mark.half, mark.y + mark.half]) {
        const to = y.clamped(end);
        group.append(Svg.line(style, px, py, px, to));
        if (!(this.figure.y.log && end <= 0) && Math.abs(to - y.place(end)) < 0.5)
          group.append(Svg.line(style, px - cap, to, px + cap, to));
      }
    }
    group.append(Svg.mark(mark.series, px, py, kind, mark.small ? 3 : 4.5));
    const circle = (style, r, more = {}) => Svg.element('circle', { class: style, cx: px, cy: py, r, ...more });
    if (this.figure.pick && mark.point === this.chosen) group.append(circle('chosen', 9));
    if (this.figure.pick && this.onPick) group.append(circle('target', 12, { 'data-point': mark.point }));
    return group;
  }

  // Lets marks be chosen with the pointer or with arrow keys.
  listen(svg) {
    svg.setAttribute('tabindex', '0');
    svg.setAttribute('role', 'application');
    svg.setAttribute('aria-label', `${svg.getAttribute('aria-label')}; arrow keys choose a point`);
    svg.addEventListener('click', (event) => {
      const { point } = event.target.dataset;
      if (point !== undefined) this.onPick(Number(point));
    });
    svg.addEventListener('keydown', (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const points = this.panels.flatMap((panel) => panel.marks.map((mark) => mark.point)),
        drawn = [...new Set(points)].sort((a, b) => a - b);
      this.onPick(drawn[(drawn.indexOf(this.chosen) + step + drawn.length) % drawn.length]);
    });
  }

  // Returns the legend, in lines at most as long as the chart is wide.
  legend(width) {
    const { kinds = [], legend = [], hasBand, bandName = 'tolerance' } = this.figure,
      items = legend.map((one) => ({ kind: 'decided', ...one }));
    const say = (isSaid, kind, text) => isSaid && items.push({ series: 0, kind, name: Format.parts(text) });
    say(kinds.includes('undecided'), 'undecided', 'not converged');
    say(kinds.includes('provisional'), 'provisional', 'provisional');
    say(kinds.includes('jammed'), 'jammed', 'jammed');
    const [low, high] = this.range('y'),
      isBeyond = ({ kind, y }) => kind !== 'jammed' && Format.isNumber(y) && (y > high || y < low);
    say(this.panels.some((panel) => panel.marks.some(isBeyond)), 'above', 'beyond the frame');
    say(hasBand, 'band', bandName);
    let x = 8,
      line = 0;
    for (const item of items) {
      const length = 26 + Svg.width(item.name);
      if (x > 8 && x + length > width) [x, line] = [8, line + 1];
      Object.assign(item, { x, line });
      x += length + 14;
    }
    const height = items.length ? 22 * (line + 1) + 6 : 0;
    const draw = (svg, top) => {
      for (const item of items) {
        const y = top + 22 * item.line + 10,
          style = `${item.kind} s${item.series % Svg.colours}`,
          at = (dx, dy) => ({ x: `${item.x + dx}`, y: `${y + dy}` });
        const sign = ['band', 'column'].includes(item.kind)
          ? Svg.element('rect', { class: style, ...at(0, -6), width: 16, height: 12 })
          : item.kind === 'line'
            ? Svg.shaded(Svg.line(style, item.x, y, item.x + 16, y), item, 'stroke')
            : Svg.mark(item.series, item.x + 8, y, item.kind);
        svg.append(Chart.group(item, sign, Svg.text(item.name, at(22, 4.5))));
      }
    };
    return { height, draw };
  }
}
