'use strict';

// Numbers, names and symbols as people read them.
const Format = {
  // Power of ten of the leading digit after rounding to two: 0.0996 is 1.0e-1.
  exponent(number) {
    return Number(number.toExponential(1).split('e')[1]);
  },

  // To the place of 10^-decimals, also left of the point.
  rounded(number, decimals) {
    if (decimals >= 0) return number.toFixed(Math.min(decimals, 100));
    const unit = 10 ** -decimals;
    return (Math.round(number / unit) * unit).toFixed(0);
  },

  isNumber(value) {
    return typeof value === 'number' && Number.isFinite(value);
  },

  // "8.93 ± 0.12": the error to two significant digits, the value to the same place.
  withError(value, error) {
    if (!Format.isNumber(value)) return '–';
    if (!Format.isNumber(error)) return `${Format.rough(value)} ± –`;
    if (error <= 0) return `${Number(value.toPrecision(6))} ± 0`;
    const decimals = 1 - Format.exponent(error);
    if (decimals <= 5 && Math.abs(value) < 1e6 && error < 1e6)
      return `${Format.rounded(value, decimals)} ± ${Format.rounded(error, decimals)}`;
    const power = Format.exponent(Math.max(Math.abs(value), error)),
      unit = 10 ** power,
      places = decimals + power;
    const [mean, half] = [value, error].map((one) => Format.rounded(one / unit, places));
    return `(${mean} ± ${half})·10${Format.raised(power)}`;
  },

  raised(power) {
    return String(power).replace(/[-0-9]/g, (c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]));
  },

  // "0.01", "2000", "5·10⁶"; four digits at most.
  plain(value) {
    const size = Math.abs(value);
    if (value === 0 || (size >= 1e-3 && size < 1e5)) return String(Number(value.toPrecision(4)));
    const power = Math.floor(Math.log10(size) + 1e-9),
      leading = value / 10 ** power;
    return (Math.abs(leading - 1) < 1e-9 ? '10' : `${Number(leading.toPrecision(4))}·10`) + Format.raised(power);
  },

  rough(value) {
    return Format.isNumber(value) ? Format.plain(Number(value.toPrecision(3))) : '–';
  },

  percent(fraction) {
    return Format.isNumber(fraction) ? `${(100 * fraction).toFixed(fraction < 0.0995 ? 1 : 0)} %` : '–';
  },

  // "45 s", "12 min", "3 h 20 min", "2 d 4 h"
  duration(seconds) {
    if (!Format.isNumber(seconds)) return '–';
    const whole = Math.round(seconds),
      minutes = Math.round(seconds / 60),
      hours = Math.round(seconds / 3600);
    if (whole < 10) return `${Format.rough(Number(seconds.toPrecision(2)))} s`;
    if (whole < 90) return `${whole} s`;
    if (minutes < 60) return `${minutes} min`;
    if (minutes < 24 * 60) return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
    return `${Math.floor(hours / 24)} d ${hours % 24} h`;
  },

  counted(number, noun) {
    return `${number} ${noun}${number === 1 ? '' : 's'}`;
  },

  words(name) {
    return name.replace(/\//g, ', ').replace(/_/g, ' ');
  },

  value(value) {
    return typeof value === 'string' ? value : JSON.stringify(value);
  },

  greek: {
    alpha: 'α',
    beta: 'β',
    gamma: 'γ',
    delta: 'δ',
    epsilon: 'ε',
    eta: 'η',
    theta: 'θ',
    kappa: 'κ',
    lambda: 'λ',
    mu: 'μ',
    nu: 'ν',
    xi: 'ξ',
    pi: 'π',
    rho: 'ρ',
    sigma: 'σ',
    tau: 'τ',
    phi: 'φ',
    chi: 'χ',
    psi: 'ψ',
    omega: 'ω',
    rate: 'γ̇',
    Gamma: 'Γ',
    Delta: 'Δ',
    Theta: 'Θ',
    Lambda: 'Λ',
    Sigma: 'Σ',
    Phi: 'Φ',
    Psi: 'Ψ',
    Omega: 'Ω',
  },

  // "N_1^noise" as N, "1" lowered, "noise" raised: [{text, level}] with level 0, -1 or 1. What is raised may be the
  // name of a term, with underscores of its own; a few letters behind its last one are lowered: sigma^noise_xy. With an
  // `element` all of it is the name, and the element is lowered. Parentheses and what follows stay: u_x(y).
  symbol(text, element = '') {
    if (!element && /[<(|]/.test(text)) return Format.formula(text);
    const [, whole, rest] = /^([^(]*)(.*)$/.exec(text);
    const [, base, below, above] = /^([^_^]*)(?:_([^^]*))?(?:\^(.*))?$/.exec(whole) || [null, whole, '', ''];
    const [, name, tail] = (element ? null : /^(.*)_(\w{1,2})$/.exec(above || '')) || [null, above, ''];
    const parts = [
      [base, 0],
      [[below, tail, element].filter(Boolean).join(' '), -1],
      [(name || '').replace(/_/g, ' '), 1],
      [rest, 0],
    ];
    return parts.filter(([part]) => part).map(([part, level]) => ({ text: Format.translated(part), level }));
  },

  translated(text) {
    return text.replace(/[A-Za-z]+/g, (word) => Format.greek[word] || word);
  },

  // A formula in words, such as "<|F_t| / (mu F_n)>": a mean, and what stands lowered behind each underscore.
  formula(text) {
    return text
      .replace(/^<(.*)>$/, '⟨$1⟩')
      .split(/(_[A-Za-z]+)/)
      .filter(Boolean)
      .map((part) => (part[0] === '_' ? [part.slice(1), -1] : [part, 0]))
      .map(([part, level]) => ({ text: Format.translated(part), level }));
  },

  // The same for matplotlib.
  mathtext(parts) {
    const inner = (text) => text.replace(/[\\${}^_%#&~]/g, '').replace(/ /g, '\\ ');
    return parts
      .map(({ text, level }) =>
        level === 0 ? text.replace(/\$/g, '\\$') : `$${level > 0 ? '^' : '_'}{\\mathrm{${inner(text)}}}$`,
      )
      .join('');
  },

  plainText(parts) {
    return parts.map((part) => part.text).join('');
  },

  unit(unit) {
    if (!unit || unit === '1') return '';
    // Made of dimensions alone, such as "stress" or "length^2 / time^2": that of the scene.
    const dimensions = ['stress', 'energy', 'time', 'length', 'mass', 'force', 'viscosity'],
      words = unit.match(/[A-Za-z]+/g) || [];
    const isOfScene = words.length > 0 && words.every((word) => dimensions.includes(word));
    if (isOfScene) return 'scene units';
    return unit
      .split(' * ')
      .map((word) => ({ viscosity: 'η', shear_rate: 'γ̇' })[word] || word.replace(/_/g, ' '))
      .join(' ');
  },

  groups: { peclet: ['Péclet number', 'Pe'], stokes: ['Stokes number', 'St'] },

  // {words, symbol: parts, unit} of a key of the scene; some come with words and symbol.
  parameter(parameter) {
    const { words, symbol } = parameter,
      bracket = /\[([^\]]*)\]\s*$/.exec(parameter.meaning || '');
    const steps = parameter.pointer.split('/').filter((step) => step !== '');
    const last = /^[0-9]+$/.test(steps[steps.length - 1]) ? steps.slice(-2) : steps.slice(-1);
    return {
      words: words || Format.words(last.join(' ')),
      symbol: symbol ? Format.keySymbol(symbol) : [],
      unit: bracket ? Format.unit(bracket[1]) : '',
    };
  },

  keySymbol(text) {
    return text.endsWith(' T') ? [...Format.symbol(text.slice(0, -2)), { text: 'T', level: 0 }] : Format.symbol(text);
  },

  // {words, symbol, unit} of what is measured.
  quantity(quantity) {
    const { element, name, symbol } = quantity;
    return {
      words: Format.words(name) + (element ? `, ${element}` : ''),
      symbol: symbol ? Format.symbol(symbol, element) : [],
      unit: Format.unit(quantity.unit),
    };
  },

  // For a list to choose from, which shows plain text only.
  option(about) {
    const plain = about.symbol.length && about.symbol.every((part) => part.level === 0);
    return about.words + (plain ? ` ${Format.plainText(about.symbol)}` : '') + (about.unit ? ` [${about.unit}]` : '');
  },

  // "relative viscosity ηr [unit]" as parts.
  title(about) {
    const parts = [{ text: about.words, level: 0 }];
    if (about.symbol.length) parts.push({ text: ' ', level: 0 }, ...about.symbol);
    if (about.unit) parts.push({ text: ` [${about.unit}]`, level: 0 });
    return parts;
  },
};
