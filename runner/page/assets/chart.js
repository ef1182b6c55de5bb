// A figure as SVG, with what it can be saved as.
//
// figure: {name, x, y: {about, log, categories}, panels: [{title, marks, lines, bands, columns, levels}], legend,
// kinds, hasBand, notes, caption, empty, table, pick, height}. Marks: {series, x, y, half, kind, point, text}; y is null of
// the kind "jammed" where there is no number; lines: {series,
// style, places: [x, y]}; bands: {series, places: [x, low, high]}; columns, which are boxes: {from, to, low, high, series,
// text}; levels: {value, across}. In the legend {series, name, kind}: "column" for a box, "line", or a mark.
class Chart {
  // `onPick(point)`: a mark of that point was chosen.
  constructor(host, onPick = null) {
    this.host = host;
    this.onPick = onPick;
    this.figure = null;
    this.chosen = null;
    this.width = 0;
    new ResizeObserver(() => {
      if (this.figure && Math.abs(host.clientWidth - this.width) > 2) this.draw();
    }).observe(host);
  }

  // A figure that is the same is left as it is.
  show(figure) {
    const key = JSON.stringify(figure);
    if (this.shown === key && this.host.firstChild) return;
    this.shown = key;
    this.figure = figure;
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
    host.replaceChildren();
    const caption = document.createElement('figcaption');
    caption.textContent = [figure.caption, ...(figure.notes || [])].filter(Boolean).join(' ');
    const isDrawn = ({ marks, lines = [], columns = [] }) =>
      marks.length + columns.length > 0 || lines.some((line) => line.places.length > 1);
    if (!figure.panels.some(isDrawn)) {
      caption.textContent = figure.empty || 'There is nothing to draw yet.';
      host.append(caption);
      return;
    }
    const svg = this.svg(Math.min(1000, Math.max(280, this.width || 720)));
    host.append(
      svg,
      caption,
      Saving.links(
        Saving.link('CSV', `${figure.name}.csv`, 'text/csv', Saving.csv(figure.table)),
        Saving.link('SVG', `${figure.name}.svg`, 'image/svg+xml', Svg.standalone(svg)),
        Saving.link('matplotlib', `${figure.name}.py`, 'text/x-python', Saving.script(figure)),
      ),
    );
    if (hadFocus) svg.focus();
  }

  // Of the numbers that are to be seen: ends of bars, but not of those that are still to shrink.
  range(direction) {
    const { figure } = this,
      numbers = [],
      log = figure[direction].log;
    for (const panel of figure.panels) {
      for (const mark of panel.marks) {
        if (direction === 'x') numbers.push(mark.x);
        else {
          numbers.push(mark.y);
          if (mark.kind !== 'provisional' && Format.isNumber(mark.half))
            numbers.push(mark.y - mark.half, mark.y + mark.half);
        }
      }
      for (const line of panel.lines || []) numbers.push(...line.places.map(([x, y]) => (direction === 'x' ? x : y)));
      for (const band of panel.bands || [])
        numbers.push(...band.places.flatMap(([x, low, high]) => (direction === 'x' ? [x] : [low, high])));
      for (const column of panel.columns || [])
        numbers.push(...(direction === 'x' ? [column.from, column.to] : [column.low, column.high]));
      for (const level of panel.levels || []) if (level.across === (direction === 'y')) numbers.push(level.value);
    }
    const usable = numbers.filter((number) => Format.isNumber(number) && (!log || number > 0));
    if (!usable.length) return log ? [1, 10] : [0, 1]; // marks at the edge alone
    // A bar that reaches almost down to zero must not squeeze all else: it is cut off.
    const centres =
      log && direction === 'y'
        ? figure.panels.flatMap((panel) => panel.marks.map((mark) => mark.y)).filter((y) => y > 0)
        : [];
    const low = usable.reduce((a, b) => Math.min(a, b), Infinity),
      high = usable.reduce((a, b) => Math.max(a, b), -Infinity);
    return [centres.length ? Math.max(low, Math.min(...centres) / 3) : low, high];
  }

  svg(width) {
    const { figure } = this,
      count = figure.panels.length;
    const columns = count === 1 ? 1 : Math.min(count, width >= 900 ? 3 : width >= 560 ? 2 : 1);
    const rows = Math.ceil(count / columns),
      cell = width / columns,
      height = figure.height || Math.max(230, Math.min(430, cell * 0.58));
    const legend = this.legend(width),
      titled = figure.panels.some((panel) => panel.title && panel.title.length);
    const total = rows * (height + (titled ? 22 : 0)) + legend.height;
    const label = [figure.y, figure.x].map(({ about }) => Format.plainText(Format.title(about))).join(' over ');
    const svg = Svg.element('svg', {
      class: 'chart',
      viewBox: `0 0 ${Svg.number(width)} ${Svg.number(total)}`,
      role: 'img',
      'aria-label': label,
    });
    const ranges = { x: this.range('x'), y: this.range('y') };
    figure.panels.forEach((panel, i) => {
      const left = (i % columns) * cell,
        top = Math.floor(i / columns) * (height + (titled ? 22 : 0)) + (titled ? 22 : 0);
      svg.append(this.panel(panel, left, top, cell, height, ranges));
    });
    legend.draw(svg, rows * (height + (titled ? 22 : 0)));
    if (figure.pick && this.onPick) this.listen(svg);
    return svg;
  }

  panel(panel, left, top, width, height, ranges) {
    const { figure } = this,
      group = Svg.element('g');
    const frame = { right: left + width - 12, top: top + 8, bottom: top + height - 48 };
    const y = new Axis({
      log: figure.y.log,
      low: ranges.y[0],
      high: ranges.y[1],
      begin: frame.bottom,
      end: frame.top,
      mostTicks: Math.max(3, Math.min(9, Math.floor((frame.bottom - frame.top) / 36))),
      categories: figure.y.categories,
    });
    // Numbers at the ticks make room for themselves beside the title.
    const widest = y.categories ? 0 : Math.max(...y.ticks().map((tick) => Svg.width(tick.text)));
    frame.left = left + Math.max(66, 32 + widest);
    const across = Math.max(3, Math.min(9, Math.floor((frame.right - frame.left) / 58)));
    const x = new Axis({
      log: figure.x.log,
      low: ranges.x[0],
      high: ranges.x[1],
      begin: frame.left,
      end: frame.right,
      mostTicks: across,
      categories: figure.x.categories,
    });
    this.frame(group, frame, x, y, panel, left, height, top);
    const visible = (mark) =>
      (!figure.y.log || mark.y > 0 || mark.kind === 'jammed') && (!figure.x.log || mark.x > 0);
    for (const band of panel.bands || []) this.band(group, band, x, y);
    for (const column of panel.columns || []) group.append(Chart.box(column, x, y));
    for (const level of panel.levels || []) this.level(group, level, frame, x, y);
    for (const line of panel.lines || []) {
      const places = line.places
        .filter(([px, py]) => visible({ x: px, y: py }))
        .map(([px, py]) => [x.place(px), y.clamped(py)]);
      if (places.length > 1) group.append(Svg.path(`${line.style} s${line.series % Svg.colours}`, places));
    }
    for (const mark of panel.marks) if (visible(mark)) group.append(this.mark(mark, x, y, frame));
    return group;
  }

  frame(group, frame, x, y, panel, left, height, top) {
    const { figure } = this,
      n = Svg.number;
    const words = x.categories ? Math.max(1, Math.ceil((x.categories.length * 60) / (frame.right - frame.left))) : 1;
    x.ticks().forEach((tick, i) => {
      const place = x.place(tick.value);
      group.append(Svg.line('grid', place, frame.top, place, frame.bottom));
      if (i % words === 0)
        group.append(Svg.text(tick.text, { x: n(place), y: n(frame.bottom + 18), 'text-anchor': 'middle' }));
    });
    const rows = y.categories ? Math.max(1, Math.ceil((y.categories.length * 15) / (frame.bottom - frame.top))) : 1;
    y.ticks().forEach((tick, i) => {
      const place = y.place(tick.value);
      group.append(Svg.line('grid', frame.left, place, frame.right, place));
      if (i % rows === 0)
        group.append(Svg.text(tick.text, { x: n(frame.left - 7), y: n(place + 4.5), 'text-anchor': 'end' }));
    });
    group.append(
      Svg.element('rect', {
        class: 'frame',
        x: n(frame.left),
        y: n(frame.top),
        width: n(frame.right - frame.left),
        height: n(frame.bottom - frame.top),
      }),
    );
    const middle = (frame.left + frame.right) / 2,
      centre = (frame.top + frame.bottom) / 2;
    group.append(
      Svg.text(Format.title(figure.x.about), {
        class: 'title',
        x: n(middle),
        y: n(top + height - 10),
        'text-anchor': 'middle',
      }),
    );
    group.append(
      Svg.text(Chart.fitting(figure.y.about, frame.bottom - frame.top), {
        class: 'title',
        transform: `translate(${n(left + 15)} ${n(centre)}) rotate(-90)`,
        'text-anchor': 'middle',
      }),
    );
    if (panel.title && panel.title.length)
      group.append(Svg.text(panel.title, { class: 'title', x: n(middle), y: n(top - 3), 'text-anchor': 'middle' }));
  }

  // One that is shorter than a pixel is still there.
  static box(column, x, y) {
    const [from, to] = [x.place(column.from), x.place(column.to)].sort((a, b) => a - b),
      [high, low] = [y.clamped(column.low), y.clamped(column.high)].sort((a, b) => a - b);
    const box = Svg.element('rect', {
      class: `column s${column.series % Svg.colours}`,
      x: Svg.number(from),
      y: Svg.number(high),
      width: Svg.number(Math.max(1, to - from)),
      height: Svg.number(low - high),
    });
    if (column.text) box.append(Svg.element('title', {}, column.text));
    return box;
  }

  // The symbol alone where the words are too long.
  static fitting(about, length) {
    const whole = Format.title(about);
    if (Svg.width(whole) <= length + 40 || !about.symbol.length) return whole;
    return Format.title({ words: '', symbol: about.symbol, unit: about.unit });
  }

  band(group, band, x, y) {
    let places = band.places;
    const pixels = places
      .map(([px, low, high]) => [x.place(px), y.clamped(low), y.clamped(high)])
      .sort((a, b) => a[0] - b[0]);
    if (pixels.length === 1) {
      const [place, low, high] = pixels[0];
      pixels.splice(0, 1, [place - 14, low, high], [place + 14, low, high]);
    }
    const outline = [...pixels.map(([px, , high]) => [px, high]), ...pixels.map(([px, low]) => [px, low]).reverse()];
    group.append(Svg.path(`band s${band.series % Svg.colours}`, outline, true));
  }

  level(group, level, frame, x, y) {
    const place = level.across ? y.clamped(level.value) : x.clamped(level.value),
      style = `${level.style || 'dashed'} s${level.series || 0}`;
    group.append(
      level.across
        ? Svg.line(style, frame.left, place, frame.right, place)
        : Svg.line(style, place, frame.top, place, frame.bottom),
    );
  }

  // What has jammed stands at its number, or at the edge of the frame: the upper one without a number, the lower one
  // where a logarithmic axis has no place for it.
  place(mark, y, frame) {
    if (mark.kind !== 'jammed') return y.place(mark.y);
    if (!Format.isNumber(mark.y)) return frame.top;
    return this.figure.y.log && mark.y <= 0 ? frame.bottom : y.place(mark.y);
  }

  mark(mark, x, y, frame) {
    const group = Svg.element('g', mark.kind === 'provisional' ? { class: 'provisional' } : {});
    const px = x.place(mark.x),
      py = this.place(mark, y, frame),
      style = `bar s${mark.series % Svg.colours}`,
      cap = 4;
    if (mark.text) group.append(Svg.element('title', {}, mark.text));
    if (Format.isNumber(mark.half) && !(this.figure.y.log && mark.y <= 0)) {
      for (const end of [mark.y - mark.half, mark.y + mark.half]) {
        const to = y.clamped(end);
        group.append(Svg.line(style, px, py, px, to));
        if (!(this.figure.y.log && end <= 0) && Math.abs(to - y.place(end)) < 0.5)
          group.append(Svg.line(style, px - cap, to, px + cap, to));
      }
    }
    group.append(Svg.mark(mark.series, px, py, mark.kind, mark.small ? 3 : 4.5));
    if (this.figure.pick && mark.point === this.chosen)
      group.append(Svg.element('circle', { class: 'chosen', cx: Svg.number(px), cy: Svg.number(py), r: 9 }));
    if (this.figure.pick && this.onPick)
      group.append(
        Svg.element('circle', {
          class: 'target',
          cx: Svg.number(px),
          cy: Svg.number(py),
          r: 12,
          'data-point': mark.point,
        }),
      );
    return group;
  }

  // Marks are chosen with pointer or arrow keys.
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
      const drawn = [...new Set(this.figure.panels.flatMap((panel) => panel.marks.map((mark) => mark.point)))].sort(
        (a, b) => a - b,
      );
      this.onPick(drawn[(drawn.indexOf(this.chosen) + step + drawn.length) % drawn.length]);
    });
  }

  // What the marks mean, in lines as long as the chart is wide.
  legend(width) {
    const { figure } = this,
      items = (figure.legend || []).map((one) => ({ kind: 'decided', ...one }));
    const kinds = figure.kinds || [],
      say = (kind, text) => items.push({ series: 0, kind, name: [{ text, level: 0 }] });
    if (kinds.includes('undecided')) say('undecided', 'not converged');
    if (kinds.includes('provisional')) say('provisional', 'provisional');
    if (kinds.includes('jammed')) say('jammed', 'jammed');
    if (figure.hasBand)
      items.push({ series: 0, kind: 'band', name: [{ text: figure.bandName || 'tolerance', level: 0 }] });
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
          group = Svg.element('g', item.kind === 'provisional' ? { class: 'provisional' } : {});
        const isBox = item.kind === 'band' || item.kind === 'column',
          style = `${item.kind} s${item.series % Svg.colours}`;
        group.append(
          isBox
            ? Svg.element('rect', { class: style, x: item.x, y: y - 6, width: 16, height: 12 })
            : Svg.mark(item.series, item.x + 8, y, item.kind),
        );
        group.append(Svg.text(item.name, { x: item.x + 22, y: y + 4.5 }));
        svg.append(group);
      }
    };
    return { height, draw };
  }
}
