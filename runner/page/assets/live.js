// Keeps the page up to date: asks the server every second for the changes since the last answer.
class Live {
  static every = 1000;
  static patience = 20000;

  constructor(data, campaign) {
    Object.assign(this, { data, campaign, token: data.live.token, program: data.live.program, lost: null });
    this.line = document.getElementById('live');
    this.changed = new Date();
    Live.current = this;
    this.known = new Map(); // details by the point's hash
  }

  start() {
    this.say();
    if (this.campaign.data) this.campaign.pick(this.campaign.place());
    setTimeout(() => this.ask(), Live.every);
  }

  async ask() {
    try {
      const response = await Live.fetch(`state?since=${encodeURIComponent(this.token)}`);
      this.lost = null;
      if (response.status === 200) this.take(await response.json());
      else if (response.status !== 204) throw new Error(`answer ${response.status}`);
    } catch (error) {
      this.lost = this.lost || new Date();
    }
    this.say();
    // A hidden page asks less often.
    setTimeout(() => this.ask(), Live.every * (document.hidden ? 10 : 1));
  }

  static fetch(path) {
    return fetch(path, { cache: 'no-store', signal: AbortSignal.timeout(Live.patience) });
  }

  take({ live, head, count, points }) {
    if (live.program !== this.program) {
      location.reload();
      return;
    }
    const known = this.data.points || [];
    this.token = live.token;
    this.changed = new Date();
    this.data = { ...head, live, points: Array.from({ length: count }, (_, i) => points[i] || known[i]) };
    this.campaign.show(this.data);
  }

  // Writes the state of the connection. Changes the text only if it is new, because screen readers read it aloud.
  say() {
    const time = (date) => date.toLocaleTimeString('en-GB'),
      shown = `The page shows the state at ${time(this.changed)}.`;
    const text = this.lost
      ? `The server has not answered since ${time(this.lost)}. ${shown} Still asking.`
      : this.data.fault
        ? `The campaign cannot be read: ${this.data.fault} ${shown}`
        : `Live; last change ${time(this.changed)}.`;
    if (this.line.textContent === text) return;
    this.line.textContent = text;
    this.line.className = this.lost || this.data.fault ? 'alarm' : 'faint';
  }

  // Returns the known details of a point on a live page, or null; asks for them if they are missing or its seeds have
  // changed. A page that is not live has them in its document.
  static details(point) {
    const live = Live.current,
      key = JSON.stringify([point.stop_tests.length, point.seeds.ended]);
    if (!live) return null;
    const known = live.known.get(point.hash) || { key: null, details: null, until: 0 };
    if (known.key !== key && performance.now() > known.until) {
      const most = 5000; // milliseconds between two questions about one point
      live.known.set(point.hash, { ...known, key, until: performance.now() + most });
      live.askFor(point.hash);
    }
    return known.details;
  }

  // Returns the details of a point that are known on a live page, or null.
  static known(point) {
    const known = Live.current && Live.current.known.get(point.hash);
    return known ? known.details : null;
  }

  async askFor(hash) {
    try {
      const response = await Live.fetch(`point?hash=${encodeURIComponent(hash)}`);
      if (!response.ok) return;
      const details = await response.json();
      this.known.set(hash, { ...this.known.get(hash), details });
      this.campaign.sweep.show(this.campaign.data);
      if (this.campaign.chosen === hash) this.campaign.pick(this.campaign.place());
    } catch (error) {
      this.lost = this.lost || new Date();
      this.say();
    }
  }
}
