// Elements, marks and text of charts. Names enter as text only, so that none is taken for markup.
const Svg = {
  // Returns an element. Numbers among its attributes are rounded to a tenth.
  element(name, attributes = {}, ...children) {
    const made = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const [key, value] of Object.entries(attributes))
      made.setAttribute(key, typeof value === 'number' ? Svg.number(value) : value);
    made.append(...children);
    return made;
  },

  number(value) {
    return String(Math.round(value * 10) / 10);
  },

  line(style, x1, y1, x2, y2) {
    return Svg.element('line', { class: style, x1, y1, x2, y2 });
  },

  through(places) {
    return places.map(([x, y], i) => `${i ? 'L' : 'M'}${Svg.number(x)} ${Svg.number(y)}`).join('');
  },

  path(style, places, closed = false) {
    return Svg.element('path', { class: style, d: Svg.through(places) + (closed ? 'Z' : '') });
  },

  // Returns the text of parts of Format.symbol(); subscripts and superscripts are smaller.
  text(parts, attributes) {
    const made = Svg.element('text', attributes);
    let shift = 0;
    for (const part of typeof parts === 'string' ? Format.parts(parts) : parts) {
      const wanted = part.level > 0 ? -5 : part.level < 0 ? 4 : 0;
      const span = Svg.element('tspan', part.level ? { 'font-size': 10 } : {}, part.text);
      if (wanted !== shift) span.setAttribute('dy', wanted - shift);
      shift = wanted;
      made.append(span);
    }
    return made;
  },

  // Returns the approximate width of text of 13 px; fonts differ.
  width(parts) {
    if (typeof parts === 'string') return Svg.width(Format.parts(parts));
    return parts.reduce((sum, part) => sum + part.text.length * (part.level ? 5.4 : 7), 0);
  },

  // Colours an element by the shade of a line or band, from blue to green; returns the element.
  shaded(element, { shade }, property) {
    if (shade !== undefined) element.style[property] = `hsl(${Math.round(270 - 200 * shade)} 55% 45%)`;
    return element;
  },

  // The shapes of marks: corners around the middle, for a radius of 1; null is a circle.
  shapes: [
    null,
    [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]],
    [[0, -1.3], [1.3, 0], [0, 1.3], [-1.3, 0]],
    [[0, -1.2], [1.2, 1], [-1.2, 1]],
    [[0, 1.2], [1.2, -1], [-1.2, -1]],
    [[-0.4, -1.2], [0.4, -1.2], [0.4, -0.4], [1.2, -0.4], [1.2, 0.4], [0.4, 0.4],
     [0.4, 1.2], [-0.4, 1.2], [-0.4, 0.4], [-1.2, 0.4], [-1.2, -0.4], [-0.4, -0.4]],
    [[-1.2, 0], [-0.6, -1.05], [0.6, -1.05], [1.2, 0], [0.6, 1.05], [-0.6, 1.05]],
  ],
  colours: 8,

  mark(series, x, y, kind, radius = 4.5) {
    if (kind === 'jammed') {
      const stroke = (turn) => [[x - 5, y - 5 * turn], [x + 5, y + 5 * turn]],
        d = [1, -1].map((turn) => Svg.through(stroke(turn)));
      return Svg.element('path', { class: `jammed s${series % Svg.colours}`, d: d.join('') });
    }
    const beyond = { above: 3, below: 4 }[kind],
      isSolid = kind === 'decided' || beyond !== undefined;
    const style = `mark s${series % Svg.colours} ${isSolid ? 'solid' : 'hollow'}`,
      shape = Svg.shapes[beyond ?? series % Svg.shapes.length];
    if (!shape) return Svg.element('circle', { class: style, cx: x, cy: y, r: radius });
    const corners = shape.map(([dx, dy]) => [x + radius * dx, y + radius * dy]);
    return Svg.path(style, corners, true);
  },

  // Returns the chart as a file, in the colours of a light page and without variables, which drawing programs lack.
  standalone(svg) {
    const copy = svg.cloneNode(true),
      colours = new Map();
    copy.removeAttribute('tabindex');
    copy.setAttribute('role', 'img');
    copy.setAttribute('aria-label', copy.getAttribute('aria-label').replace(/; arrow keys choose a point$/, ''));
    for (const extra of copy.querySelectorAll('.target, .chosen')) extra.remove();
    let style = '';
    for (const rule of document.styleSheets[0].cssRules) {
      if (rule.selectorText === ':root') {
        for (const name of rule.style)
          if (name.startsWith('--')) colours.set(name, rule.style.getPropertyValue(name).trim());
      } else if (/^\.chart (?!\.target|\.chosen)/.test(rule.selectorText || '')) {
        style += rule.cssText.replace(/var\((--\w+)\)/g, (_, name) => colours.get(name)) + '\n';
      }
    }
    copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
    const [, , width, height] = copy.getAttribute('viewBox').split(' ');
    copy.setAttribute('width', width);
    copy.setAttribute('height', height);
    copy.prepend(Svg.element('style', {}, style), Svg.element('rect', { width, height, fill: colours.get('--page') }));
    return new XMLSerializer().serializeToString(copy) + '\n';
  },
};

// Links that save a chart or table. They hold their files, so that they work without a network or a server.
const Saving = {
  // Returns a field quoted as in RFC 4180. An apostrophe precedes text that a spreadsheet would run as a formula.
  csvField(value) {
    if (value === null || value === undefined) return '';
    if (typeof value !== 'string') return Format.isNumber(value) ? String(value) : JSON.stringify(value);
    const safe = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
    return /[",\r\n]/.test(safe) ? `"${safe.replace(/"/g, '""')}"` : safe;
  },

  csv({ columns, rows }) {
    return [columns, ...rows].map((row) => row.map(Saving.csvField).join(',') + '\n').join('');
  },

  // Returns a value as JSON in ASCII, which Python reads as the same value.
  ascii(value) {
    const escape = (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, '0')}`;
    return JSON.stringify(value).replace(/[^\x20-\x7e]/g, escape);
  },

  // Returns the script that draws the figure again, with its data as one string.
  script(figure) {
    const data = Saving.ascii(Saving.ascii(figure));
    return `${drawingScript}\n\nFIGURE = json.loads(${data})\n\nif __name__ == "__main__":\n    main(FIGURE)\n`;
  },

  fileName(text) {
    const plain = text.replace(/[^A-Za-z0-9._-]+/g, '-').replace(/^[-.]+|-+$/g, '');
    return plain.slice(0, 80) || 'peclet';
  },

  link(text, name, type, content) {
    const download = Saving.fileName(name.replace(/\.\w+$/, '')) + /\.\w+$/.exec(name)[0],
      href = `data:${type};charset=utf-8,${encodeURIComponent(content)}`;
    return Page.element('a', { download, href }, text);
  },

  links(...links) {
    return Page.element('p', { className: 'saves faint' }, 'Save as: ', ...links);
  },
};
