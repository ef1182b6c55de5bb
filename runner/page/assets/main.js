// The page of a campaign. Its parts stay; the data may change while the page is open.
class Campaign {
  chosen = null; // hash of the point

  part(id) {
    return document.getElementById(id);
  }

  show(data) {
    const anchor = Campaign.anchor(),
      top = anchor.getBoundingClientRect().top,
      pick = (index) => this.pick(index);
    document.querySelector('main').hidden = Boolean(data.waiting);
    this.part('headline').textContent = data.waiting || headline(data);
    this.part('question').textContent = data.waiting ? '' : question(data);
    if (data.waiting) return;
    this.data = data;
    if (!this.sweep) {
      this.sweep = new SweepView(this.part('sweep'), pick);
      this.point = new PointView(this.part('point'), pick);
    }
    this.sweep.show(data);
    const { sweep } = this.sweep;
    Page.renew(this.part('results'), resultsShown(data), (host) => {
      this.table = resultsTable(data, sweep, host, pick);
    });
    this.pick(Math.max(0, this.place()));
    Page.renew(this.part('doubts'), doubtsShown(data), (host) => writeDoubts(data, host));
    if (data.work.attempts.length) {
      this.work = this.work || new WorkView(this.part('work'));
      this.work.show(data);
    }
    Page.renew(this.part('cost'), costShown(data), (host) => writeCost(data, host, pick));
    Page.renew(this.part('origin'), originShown(data), (host) => writeOrigin(data, sweep, host));
    const now = anchor.isConnected ? anchor : document.activeElement;
    window.scrollBy(0, now.getBoundingClientRect().top - top);
  }

  // Returns the element that must not move when parts above it change their height: the one with the focus if it is
  // visible, otherwise the section at the top of the window.
  static anchor() {
    const candidates = [...document.querySelectorAll('main > section')];
    if (document.activeElement && document.activeElement !== document.body) candidates.unshift(document.activeElement);
    const seen = candidates.find((one) => {
      const { top, bottom } = one.getBoundingClientRect();
      return bottom > 0 && top < window.innerHeight;
    });
    return seen || document.body;
  }

  // Returns the place of the chosen point, or -1.
  place() {
    return this.data.points.findIndex((point) => point.hash === this.chosen);
  }

  pick(index) {
    const point = this.data.points[index];
    if (!point) return;
    this.chosen = point.hash;
    this.point.show(this.data, index);
    this.sweep.chart.choose(index);
    this.table.choose(index);
  }
}

// Opens all folded parts while the page is printed.
function unfoldForPrint() {
  let folded = [];
  window.addEventListener('beforeprint', () => {
    folded = [...document.querySelectorAll('details:not([open])')];
    for (const details of folded) details.open = true;
  });
  window.addEventListener('afterprint', () => {
    for (const details of folded) details.open = false;
  });
}

const pageData = JSON.parse(document.getElementById('data').textContent),
  campaign = new Campaign();
campaign.show(pageData);
unfoldForPrint();
if (pageData.live) new Live(pageData, campaign).start();
