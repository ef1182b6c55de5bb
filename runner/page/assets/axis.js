// Returns the widest gap between neighbours as a share of the range. Requires numbers in order, not all equal.
function widestGap(numbers) {
  let widest = 0;
  for (let i = 1; i < numbers.length; ++i) widest = Math.max(widest, numbers[i] - numbers[i - 1]);
  return widest / (numbers[numbers.length - 1] - numbers[0]);
}

// True if positive numbers span a factor of five or more and lie more evenly on a logarithmic axis: a viscosity that
// diverges, Péclet numbers of 1, 10, 100; not volume fractions of 0.1, 0.2 ... 0.6.
function isLogarithmic(values) {
  const leastRatio = 5; // below, there are too few round numbers
  const numbers = [...values].sort((a, b) => a - b);
  if (numbers.length === 0 || numbers[0] <= 0 || numbers[numbers.length - 1] < leastRatio * numbers[0]) return false;
  return widestGap(numbers.map(Math.log)) < widestGap(numbers);
}

// An axis of a chart: the places of numbers, and the ticks.
class Axis {
  // The axis shows `low` to `high`, with a margin on both sides, between the pixels `begin` and `end`. Both are positive
  // on a logarithmic one. `categories` are words that stand at 0, 1, 2 ... in the place of numbers.
  constructor({ log = false, low, high, begin, end, mostTicks = 9, categories = null, margin = 0.05 }) {
    Object.assign(this, { log, begin, end, mostTicks, categories });
    this.low = log ? Math.log10(low) : low;
    this.high = log ? Math.log10(high) : high;
    if (categories) [this.low, this.high] = [-0.5, categories.length - 0.5];
    const size = Math.max(Math.abs(this.low), Math.abs(this.high));
    let width = this.high - this.low;
    if (width <= 1e-9 * size || width === 0) width = size > 0 ? size : 1;
    this.low -= margin * width;
    this.high += margin * width;
  }

  place(value) {
    const number = this.log ? Math.log10(value) : value;
    return this.begin + ((number - this.low) / (this.high - this.low)) * (this.end - this.begin);
  }

  // Returns the place of a number, at most that of an end; a number without a logarithm is at the beginning.
  clamped(value) {
    if (this.log && !(value > 0)) return this.begin;
    const [from, to] = this.begin < this.end ? [this.begin, this.end] : [this.end, this.begin];
    return Math.min(to, Math.max(from, this.place(value)));
  }

  ticks() {
    if (this.categories) return this.categories.map((text, value) => ({ value, text }));
    const values = this.log ? this.logarithmicTicks() : this.linearTicks();
    return values.map((value) => ({ value, text: Format.plain(value) }));
  }

  // Returns numbers that are 1, 2 or 5 times a power of ten apart.
  linearTicks(low = this.low, high = this.high) {
    for (let unit = 10 ** (Math.floor(Math.log10(high - low)) - 1); ; unit *= 10) {
      for (const multiple of [1, 2, 5]) {
        const step = multiple * unit,
          first = Math.ceil(low / step),
          last = Math.floor(high / step);
        if (last - first >= this.mostTicks) continue;
        return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
      }
    }
  }

  // Returns every `stride`-th power of ten times each of `multiples`.
  powers(stride, multiples) {
    const ticks = [];
    for (let power = Math.floor(this.low); power <= this.high + 1; ++power) {
      if (power % stride !== 0) continue;
      for (const multiple of multiples) {
        const value = Number(`${multiple}e${power}`),
          place = Math.log10(value);
        if (place >= this.low && place <= this.high) ticks.push(value);
      }
    }
    return ticks;
  }

  logarithmicTicks() {
    for (const multiples of [[1, 2, 5], [1], [1, 2, 3, 4, 5, 6, 7, 8, 9], [1, 2, 3, 5, 7]]) {
      const ticks = this.powers(1, multiples);
      if (ticks.length >= 3 && ticks.length <= this.mostTicks) return ticks;
    }
    // Less than a factor of ten has the ticks of a linear axis.
    if (this.high - this.low < 1)
      return this.linearTicks(10 ** this.low, 10 ** this.high).filter((value) => value > 0);
    for (let stride = 1; ; ++stride) {
      const ticks = this.powers(stride, [1]);
      if (ticks.length <= this.mostTicks) return ticks;
    }
  }
}
