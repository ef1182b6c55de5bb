// The numbers that follow from the scene of each point: axes of figures, and units of numbers along an axis. The rules
// are those of `peclet plot --over` and `--scale-x`, `--scale-y` (runner/page/derived_numbers.cpp).
class Derived {
  constructor(data) {
    this.points = data.points;
    this.descriptions = data.derived.filter((one) =>
      this.points.every((point) => point.groups && Format.isNumber(point.groups[one.name]) && point.groups[one.name] !== 0),
    );
  }

  values(name) {
    return this.points.map((point) => point.groups[name]);
  }

  // Returns the numbers that differ between points, as parameters that only serve as an axis.
  axes() {
    return this.descriptions
      .map((one) => {
        const cells = this.values(one.name),
          values = [...new Set(cells)].sort((a, b) => a - b);
        return { pointer: one.name, meaning: '', about: Format.group(one.name, this.descriptions), numeric: true, cells, values };
      })
      .filter((one) => one.values.length > 1);
  }

  static power(unit, other) {
    const [own, given] = [unit, other].map((text) => text.replace(/ /g, ''));
    if (!own || own === '1') return 0;
    if (own === given) return 1;
    return `1/${own}` === given || own === `1/${given}` ? -1 : 0;
  }

  // Returns the scales of numbers in `unit`: {id, option, text, factors}. Numbers in the unit of a derived number are divided by
  // it, those in 1 / its unit are multiplied by it. A unit that is the symbol of a derived number, such as η γ̇, stands
  // for this number.
  scales(unit) {
    const bare = (text) => (text || '').replace(/ /g, ''),
      ofUnit = this.descriptions.find((one) => bare(one.symbol) && bare(one.symbol) === bare(unit)),
      given = ofUnit ? ofUnit.unit || '' : unit;
    return this.descriptions
      .filter((one) => one !== ofUnit && Derived.power(one.unit || '', given) !== 0)
      .map((one) => {
        const divides = Derived.power(one.unit || '', given) > 0,
          base = ofUnit ? this.values(ofUnit.name) : this.points.map(() => 1),
          own = this.values(one.name),
          { words } = Format.group(one.name, this.descriptions),
          factor = !one.symbol ? words : /[ /]/.test(one.symbol) ? `(${one.symbol})` : one.symbol;
        return {
          id: one.name,
          option: (divides ? '/ ' : '× ') + words,
          text: (divides ? ' / ' : ' ') + factor,
          factors: base.map((value, i) => (divides ? value / own[i] : value * own[i])),
        };
      });
  }

  // Returns a description whose numbers are scaled.
  static scaled(about, scale) {
    if (!scale) return about;
    const name = about.symbol.length ? about.symbol : Format.parts(about.words);
    return { words: about.symbol.length ? about.words : '', symbol: [...name, ...Format.symbol(scale.text)], unit: '' };
  }
}
