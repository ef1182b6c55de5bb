// The page: its data and its parts.
const Page = {
  element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  },
  // Text, or parts of Format.symbol(), into an element.
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
  // options: [[value, text, group]], in the order of their groups.
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
  // Other entries of a list; what was chosen stays chosen, and a list that is open stays as it is if nothing is new.
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
  // Makes a section anew when what it shows has changed. What was open stays open, the focus stays where it was, and
  // text that somebody is about to copy is left alone until the next time.
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

// One line that says how the campaign stands.
function headline({ progress }) {
  const parts = [`${progress.decided} of ${Format.counted(progress.points, 'point')} decided`];
  const others = Object.entries(progress.states).filter(([name]) => !['converged', 'complete', 'open'].includes(name));
  if (others.length) parts[0] += ` (${others.map(([name, count]) => `${count} ${name}`).join(', ')})`;
  const ahead = progress.seconds_to_go;
  parts.push(`${Format.duration(progress.cpu_seconds)} of processor time spent`);
  if (ahead && ahead.likely > 0)
    parts.push(`${Format.duration(ahead.likely)} to go (${[ahead.low, ahead.high].map(Format.duration).join(' to ')})`);
  if (progress.owner !== null) parts.push(`${Format.counted(progress.workers, 'worker')} busy`);
  else if (progress.check === 4) parts.push('nobody runs it now');
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
