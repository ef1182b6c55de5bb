
'use strict';

// Numbers, names and symbols as people read them.
const Format = {
  // Power of ten of the leading digit after rounding to two: 0.0996 is 1.0e-1.
  exponent(number) { return Number(number.toExponential(1).split('e')[1]); },

  // To the place of 10^-decimals, also left of the point.
  rounded(number, decimals) {
    if (decimals >= 0) return number.toFixed(Math.min(decimals, 100));
    const unit = 10 ** -decimals;
    return (Math.round(number / unit) * unit).toFixed(0);
  },

  isNumber(value) { return typeof value === 'number' && Number.isFinite(value); },

  // "8.93 ± 0.12": the error to two significant digits, the value to the same place.
  withError(value, error) {
    if (!Format.isNumber(value)) return '–';
    if (!Format.isNumber(error)) return `${Format.rough(value)} ± –`;
    if (error <= 0) return `${Number(value.toPrecision(6))} ± 0`;
    const decimals = 1 - Format.exponent(error);
    if (decimals <= 5 && Math.abs(value) < 1e6 && error < 1e6)
      return `${Format.rounded(value, decimals)} ± ${Format.rounded(error, decimals)}`;
    const power = Format.exponent(Math.max(Math.abs(value), error)), unit = 10 ** power, places = decimals + power;
    return `(${Format.rounded(value / unit, places)} ± ${Format.rounded(error / unit, places)})·10${Format.raised(power)}`;
  },

  raised(power) { return String(power).replace(/[-0-9]/g, c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]); },

  // "0.01", "2000", "5·10⁶"; four digits at most.
  plain(value) {
    const size = Math.abs(value);
    if (value === 0 || (size >= 1e-3 && size < 1e5)) return String(Number(value.toPrecision(4)));
    const power = Math.floor(Math.log10(size) + 1e-9), leading = value / 10 ** power;
    return (Math.abs(leading - 1) < 1e-9 ? '10' : `${Number(leading.toPrecision(4))}·10`) + Format.raised(power);
  },

  rough(value) { return Format.isNumber(value) ? Format.plain(Number(value.toPrecision(3))) : '–'; },

  percent(fraction) {
    return Format.isNumber(fraction) ? `${(100 * fraction).toFixed(fraction < 0.0995 ? 1 : 0)} %` : '–';
  },

  // "45 s", "12 min", "3 h 20 min", "2 d 4 h"
  duration(seconds) {
    if (!Format.isNumber(seconds)) return '–';
    const whole = Math.round(seconds), minutes = Math.round(seconds / 60), hours = Math.round(seconds / 3600);
    if (whole < 10) return `${Format.rough(Number(seconds.toPrecision(2)))} s`;
    if (whole < 90) return `${whole} s`;
    if (minutes < 60) return `${minutes} min`;
    if (minutes < 24 * 60) return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
    return `${Math.floor(hours / 24)} d ${hours % 24} h`;
  },

  counted(number, noun) { return `${number} ${noun}${number === 1 ? '' : 's'}`; },

  words(name) { return name.replace(/\//g, ', ').replace(/_/g, ' '); },

  value(value) {
    if (Format.isNumber(value)) return Format.plain(value) === '' ? String(value) : String(value);
    return typeof value === 'string' ? value : JSON.stringify(value);
  },

  greek: { alpha: 'α', beta: 'β', gamma: 'γ', delta: 'δ', epsilon: 'ε', eta: 'η', theta: 'θ', kappa: 'κ', lambda: 'λ',
    mu: 'μ', nu: 'ν', xi: 'ξ', pi: 'π', rho: 'ρ', sigma: 'σ', tau: 'τ', phi: 'φ', chi: 'χ', psi: 'ψ', omega: 'ω',
    Gamma: 'Γ', Delta: 'Δ', Theta: 'Θ', Lambda: 'Λ', Sigma: 'Σ', Phi: 'Φ', Psi: 'Ψ', Omega: 'Ω' },

  // "sigma^noise_xy" as σ, "noise" raised, "xy" lowered: [{text, level}] with level 0, 1 or -1. A word after ^ goes up to
  // the last _ behind it, because names of terms have underscores themselves.
  symbol(text) {
    const parts = [], match = /^([^_^]*)(?:\^(.*?))?(?:_([^_^]*))?$/.exec(text);
    if (!match) return [{ text, level: 0 }];
    const translate = part => part.replace(/[A-Za-z]+/g, word => Format.greek[word] || word);
    if (match[1]) parts.push({ text: translate(match[1]), level: 0 });
    if (match[3]) parts.push({ text: translate(match[3]), level: -1 });
    if (match[2]) parts.push({ text: translate(match[2]).replace(/_/g, ' '), level: 1 });
    return parts;
  },

  // The same for matplotlib.
  mathtext(parts) {
    return parts.map(part => part.level === 0 ? part.text :
      `$${part.level > 0 ? '^' : '_'}{\\mathrm{${part.text.replace(/[\\${}^_%#&~]/g, '').replace(/ /g, '\\ ')}}}$`).join('');
  },

  plainText(parts) { return parts.map(part => part.text).join(''); },

  unit(unit) {
    if (!unit || unit === '1') return '';
    return unit.split(' * ').map(word => ({ viscosity: 'η', shear_rate: 'γ̇' })[word] || Format.words(word)).join(' ');
  },

  // What the page calls keys of a scene: words and symbol.
  keys: { '/peclet': ['Péclet number', 'Pe'], '/volume_fraction': ['volume fraction', 'phi'],
    '/flow/shear_rate': ['shear rate', 'γ̇'], '/contact/friction': ['coefficient of friction', 'mu'],
    '/contact/rolling_friction': ['coefficient of rolling friction', 'mu_r'],
    '/contact/normal_stiffness': ['normal stiffness', 'k_n'], '/particles/count': ['number of particles', 'N'],
    '/fluid/viscosity': ['viscosity of the fluid', 'eta'], '/fluid/thermal_energy': ['thermal energy', 'k_B T'],
    '/particles/density': ['density of the particles', 'rho'] },

  groups: { peclet: ['Péclet number', 'Pe'], stokes: ['Stokes number', 'St'] },

  // {words, symbol: parts, unit} of a swept parameter.
  parameter(parameter) {
    const known = Format.keys[parameter.pointer], bracket = /\[([^\]]*)\]\s*$/.exec(parameter.meaning || '');
    const steps = parameter.pointer.split('/').filter(step => step !== '');
    const last = steps.length && /^[0-9]+$/.test(steps[steps.length - 1]) ? steps.slice(-2) : steps.slice(-1);
    return { words: known ? known[0] : Format.words(last.join(' ')), symbol: known ? Format.keySymbol(known[1]) : [],
      unit: bracket ? bracket[1] : '' };
  },

  keySymbol(text) {
    return text.endsWith(' T') ? [...Format.symbol(text.slice(0, -2)), { text: 'T', level: 0 }] : Format.symbol(text);
  },

  // {words, symbol, unit} of what is measured.
  quantity(quantity) {
    const element = quantity.element;
    let symbol = quantity.symbol;
    if (symbol && element && !symbol.includes('_')) symbol += `_${element}`;
    return { words: Format.words(quantity.name) + (element ? `, ${element}` : ''), symbol: Format.symbol(symbol || ''),
      unit: Format.unit(quantity.unit) };
  },

  // "relative viscosity ηr [unit]" as parts.
  title(about) {
    const parts = [{ text: about.words, level: 0 }];
    if (about.symbol.length) parts.push({ text: ' ', level: 0 }, ...about.symbol);
    if (about.unit) parts.push({ text: ` [${about.unit}]`, level: 0 });
    return parts;
  },
};
