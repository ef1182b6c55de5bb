'use strict';

// Texts of numbers, names and symbols.
const Format = {
  // Returns the power of ten of the leading digit, after rounding to two digits: -1 for 0.0996, which is 1.0e-1.
  exponent(number) {
    return Number(number.toExponential(1).split('e')[1]);
  },

  // Rounds to the place of 10^-decimals, also left of the point.
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

  // Returns plain text as parts, like those of Format.symbol().
  parts(text) {
    return [{ text, level: 0 }];
  },

  // Returns the parts [{text, level}] of a symbol such as η_r or σ_xy^{contact normal}. Level -1 is a subscript, after _, 1
  // a superscript, after ^: letters and digits, or all between braces. `element` is added to the subscript of the name.
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

  // Returns the unit to show; "" for a pure number.
  unit(unit) {
    return unit === '1' ? '' : unit;
  },

  // Returns a description {words, symbol: parts, unit} without a symbol.
  about(words, unit = '') {
    return { words, symbol: [], unit };
  },

  // Returns the symbol of a description, or its words if it has no symbol.
  short(about) {
    return about.symbol.length ? about.symbol : about.words;
  },

  // Returns the description of a key of the scene. A key for which the engine has no words is named by its last step, an
  // element of a list by its last two.
  parameter({ pointer, words, symbol, unit }) {
    const steps = pointer.split('/').filter((step) => step !== '');
    const last = /^[0-9]+$/.test(steps[steps.length - 1]) ? steps.slice(-2) : steps.slice(-1);
    return { words: words || Format.words(last.join(' ')), symbol: Format.symbol(symbol), unit: Format.unit(unit) };
  },

  // Returns the description of a number that follows from the scene; `known` has those that the engine describes.
  group(name, known) {
    const { words = '', symbol = '', unit = '' } = known.find((one) => one.name === name) || {};
    return { words: words || Format.words(name), symbol: Format.symbol(symbol), unit: Format.unit(unit) };
  },

  // Returns the description of a measured quantity.
  quantity(quantity) {
    const { element, name, symbol, unit } = quantity,
      words = Format.words(name) + (element ? `, ${element}` : '');
    return { words, symbol: symbol ? Format.symbol(symbol, element) : [], unit: Format.unit(unit) };
  },

  // Returns a description as plain text, for a list of choices.
  option(about) {
    const plain = about.symbol.length && about.symbol.every((part) => part.level === 0);
    return about.words + (plain ? ` ${Format.plainText(about.symbol)}` : '') + (about.unit ? ` [${about.unit}]` : '');
  },

  // Returns the parts of a title: "relative viscosity ηr [unit]".
  title(about) {
    const symbol = about.symbol.length ? [...Format.parts(' '), ...about.symbol] : [],
      unit = about.unit ? [...Format.parts(' ['), ...Format.symbol(about.unit), ...Format.parts(']')] : [];
    return [...Format.parts(about.words), ...symbol, ...unit];
  },
};
