// What results hold of a point and no table does: the course of the target within the window, profiles, distributions.
class DetailsView {
  constructor() {
    this.host = document.createElement('div');
    this.host.className = 'pair';
    this.charts = [];
  }

  // A live page asks for them; until they come there are none.
  show(data, point, about) {
    const details = point.details || Live.details(point);
    const figures = details ? [...DetailsView.blocks(data, point, about, details), ...DetailsView.profiles(data, point, details)] : [];
    while (this.charts.length > figures.length) this.charts.pop().host.remove();
    figures.forEach((figure, i) => {
      if (!this.charts[i]) {
        this.charts.push(new Chart(document.createElement('figure')));
        this.host.append(this.charts[i].host);
      }
      this.charts[i].show(figure);
    });
  }

  static seeds({ seeds, of }) {
    return seeds < of ? `the first ${seeds} of ${of} seeds` : Format.counted(seeds, 'seed');
  }

  // A line with its interval; it leads past what does not exist.
  static curve(xs, { mean, half_width: half }) {
    const known = xs.map((_, i) => i).filter((i) => Format.isNumber(mean[i])),
      banded = known.filter((i) => Format.isNumber(half[i]));
    return {
      marks: [],
      lines: [{ series: 0, style: 'line', places: known.map((i) => [xs[i], mean[i]]) }],
      bands: banded.length
        ? [{ series: 0, places: banded.map((i) => [xs[i], mean[i] - half[i], mean[i] + half[i]]) }]
        : [],
    };
  }

  static blocks(data, point, about, details) {
    if (!details.blocks) return [];
    const { mean, half_width: half } = details.blocks,
      parts = mean.length,
      xs = mean.map((_, i) => (100 * (i + 0.5)) / parts);
    const known = mean.filter(Format.isNumber),
      whole = known.reduce((sum, value) => sum + value, 0) / known.length;
    const verdict = point.marks.includes('transient')
      ? 'Transient: the beginning differs from the end, so that the window begins before the equilibration is over.'
      : point.marks.includes('no-transient-test')
        ? 'There was no test for a transient.'
        : point.looks.length
          ? 'No transient was found at the last look.'
          : 'No look has tested it for a transient yet.';
    return [
      {
        name: `${data.campaign} ${point.label} window`,
        height: 260,
        x: { about: { words: 'part of the measured window', symbol: [], unit: '%' }, log: false },
        y: { about, log: false },
        panels: [{ ...DetailsView.curve(xs, details.blocks), levels: [{ value: whole, across: true, series: 1 }] }],
        table: { columns: ['window_percent', 'mean', 'half_width'], rows: xs.map((x, i) => [x, mean[i], half[i]]) },
        hasBand: half.some(Format.isNumber),
        bandName: 'its interval',
        caption: `Course within the window, mean of ${DetailsView.seeds(details)} in each of ${parts} parts. ${verdict}`,
      },
    ];
  }

  static profiles(data, point, details) {
    return details.profiles.map((profile) => {
      const { axis } = profile,
        about = Format.quantity({ ...profile, element: '' }),
        log = isLogarithmic(axis.values);
      return {
        name: `${data.campaign} ${point.label} ${profile.name}`,
        height: 260,
        x: { about: { words: Format.words(axis.name), symbol: [], unit: Format.unit(axis.unit) }, log },
        y: { about, log: false },
        panels: [DetailsView.curve(axis.values, profile)],
        table: {
          columns: [axis.name, 'mean', 'standard_error', 'half_width'],
          rows: axis.values.map((x, i) => [x, profile.mean[i], profile.standard_error[i], profile.half_width[i]]),
        },
        hasBand: profile.half_width.some(Format.isNumber),
        bandName: 'its interval',
        caption: `${about.words}: mean of ${DetailsView.seeds(details)}.`,
      };
    });
  }
}
