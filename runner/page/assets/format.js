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

  // Plain text as parts of Format.symbol().
  parts(text) {
    return [{ text, level: 0 }];
  },

  // A symbol as engines write it, such as η_r or σ_xy^{contact normal}, as parts [{text, level}]: what follows _ is lowered
  // (-1), what follows ^ raised (1), letters and digits or all between braces. An `element` is lowered behind the name.
  symbol(text, element = '') {
    const named = !element
      ? text
      : text.replace(
          /^([^_^(]*)(?:_([\p{L}\p{N}]+|\{[^}]*\}))?/u,
          (_, base, below = '') => `${base}_{${[below.replace(/[{}]/g, ''), element].filter(Boolean).join(' ')}}`,
        );
    return named
      .split(/([_^](?:[\p{L}\p{N}]+|\{[^}]*\}))/u)
      .flatMap((part, i) =>
        i % 2 ? { text: part.slice(1).replace(/[{}]/g, ''), level: part[0] === '_' ? -1 : 1 } : Format.parts(part),
      )
      .filter((part) => part.text);
  },

  plainText(parts) {
    return parts.map((part) => part.text).join('');
  },

  // A pure number has none.
  unit(unit) {
    return unit === '1' ? '' : unit;
  },

  // {words, symbol: parts, unit} of what has no symbol.
  about(words, unit = '') {
    return { words, symbol: [], unit };
  },

  // The symbol of what is described so, or else its words.
  short(about) {
    return about.symbol.length ? about.symbol : about.words;
  },

  // {words, symbol: parts, unit} of a key of the scene. One that the engine has no words for is called by its last step,
  // an element of a list by its last two.
  parameter({ pointer, words, symbol, unit }) {
    const steps = pointer.split('/').filter((step) => step !== '');
    const last = /^[0-9]+$/.test(steps[steps.length - 1]) ? steps.slice(-2) : steps.slice(-1);
    return { words: words || Format.words(last.join(' ')), symbol: Format.symbol(symbol), unit: Format.unit(unit) };
  },

  // The same of a number that follows from the scene; `known` is what the engine says of such.
  group(name, known) {
    const { words = '', symbol = '', unit = '' } = known.find((one) => one.name === name) || {};
    return { words: words || Format.words(name), symbol: Format.symbol(symbol), unit: Format.unit(unit) };
  },

  // {words, symbol, unit} of what is measured.
  quantity(quantity) {
    const { element, name, symbol, unit } = quantity,
      words = Format.words(name) + (element ? `, ${element}` : '');
    return { words, symbol: symbol ? Format.symbol(symbol, element) : [], unit: Format.unit(unit) };
  },

  // For a list to choose from, which shows plain text only.
  option(about) {
    const plain = about.symbol.length && about.symbol.every((part) => part.level === 0);
    return about.words + (plain ? ` ${Format.plainText(about.symbol)}` : '') + (about.unit ? ` [${about.unit}]` : '');
  },

  // "relative viscosity ηr [unit]" as parts.
  title(about) {
    const symbol = about.symbol.length ? [...Format.parts(' '), ...about.symbol] : [],
      unit = about.unit ? [...Format.parts(' ['), ...Format.symbol(about.unit), ...Format.parts(']')] : [];
    return [...Format.parts(about.words), ...symbol, ...unit];
  },
};
