// Elements of the page.
const Page = {
  element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  },
  // Appends text, or parts of Format.symbol(), to an element.
  fill(element, content) {
    for (const { text, level } of Array.isArray(content) ? content : Format.parts(content))
      element.append(level ? Page.element(level > 0 ? 'sup' : 'sub', {}, text) : text);
    return element;
  },
  heading(level, text) {
    return Page.element(level, {}, text);
  },
  paragraph(content, className = '') {
    return Page.fill(Page.element('p', className ? { className } : {}), content);
  },
  details(title) {
    return Page.element('details', {}, Page.element('summary', {}, title));
  },
  labelled(text, control) {
    return Page.element('label', {}, text, control);
  },
  // Returns a list of choices. `options` are [value, text, group], ordered by group.
  select(options, onChange) {
    const select = Page.element('select');
    Page.refill(select, options);
    select.addEventListener('change', onChange);
    return select;
  },
  list(items) {
    const row = ([term, meaning]) => [Page.fill(Page.element('dt'), term), Page.fill(Page.element('dd'), meaning)];
    return Page.element('dl', {}, ...items.flatMap(row));
  },
  // Replaces the entries of a list, if they have changed. The entry with the chosen text stays chosen.
  refill(select, options) {
    const key = JSON.stringify(options);
    if (select.filled === key) return;
    select.filled = key;
    const chosen = select.selectedOptions.length ? select.selectedOptions[0].text : null;
    select.replaceChildren();
    let place = select;
    for (const [value, text, group] of options) {
      if (group && place.label !== group) {
        place = Page.element('optgroup', { label: group });
        select.append(place);
      }
      place.append(new Option(text, value));
    }
    const same = [...select.options].find((option) => option.text === chosen);
    if (same) select.value = same.value;
  },
  // Builds a section anew if what it shows has changed. Open folds stay open, and the focus stays where it was. A section
  // with selected text is left alone until the next call.
  renew(section, shown, build) {
    const key = JSON.stringify(shown),
      selection = document.getSelection();
    if (section.shown === key) return;
    if (section.shown && selection && !selection.isCollapsed && section.contains(selection.anchorNode)) return;
    section.shown = key;
    const open = [...section.querySelectorAll('details')].map((details) => details.open);
    const stops = () => [...section.querySelectorAll('a, button, summary, select, input, [tabindex]')];
    const at = stops().indexOf(document.activeElement),
      name = at < 0 ? '' : document.activeElement.textContent;
    section.replaceChildren();
    build(section);
    [...section.querySelectorAll('details')].forEach((details, i) => {
      details.open = details.open || Boolean(open[i]);
    });
    if (at < 0) return;
    const now = stops(),
      next = now.find((stop) => stop.textContent === name) || now[at];
    if (next) next.focus({ preventScroll: true });
  },
};

// Returns the state of the campaign in one line.
function headline({ progress }) {
  const parts = [`${progress.decided} of ${Format.counted(progress.points, 'point')} decided`];
  const others = Object.entries(progress.states).filter(([name]) => !['converged', 'complete', 'open'].includes(name));
  if (others.length) parts[0] += ` (${others.map(([name, count]) => `${count} ${name}`).join(', ')})`;
  const ahead = progress.seconds_to_go;
  parts.push(`${Format.duration(progress.cpu_seconds)} of processor time spent`);
  if (ahead && ahead.likely > 0)
    parts.push(`${Format.duration(ahead.likely)} to go (${[ahead.low, ahead.high].map(Format.duration).join(' to ')})`);
  if (progress.owner !== null) parts.push(`${Format.counted(progress.workers, 'worker')} busy`);
  else if (progress.check === 4) parts.push('not running now');
  if (progress.seeds.handed_over) parts.push(`${Format.counted(progress.seeds.handed_over, 'seed')} handed over`);
  return parts.join(' · ');
}

function question({ target }) {
  const { minimum, maximum } = target,
    seeds = minimum === maximum ? maximum : `${minimum} to ${maximum}`;
  return (
    `${Format.words(target.text)} at ${Format.rough(100 * target.confidence)} % confidence, ` +
    `with ${seeds} independent realisations (seeds) of every point.`
  );
}
