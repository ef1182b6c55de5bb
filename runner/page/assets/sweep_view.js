// The chart over the sweep and what is chosen for it.
class SweepView {
  constructor(host, onPick) {
    [this.quantity, this.axis, this.panels] = ['quantity', 'axis', 'panels'].map((id) => {
      const select = Page.select([], () => (id === 'panels' ? this.draw() : this.renew()));
      select.id = id;
      return select;
    });
    [this.logX, this.logY, this.stacked] = ['log-x', 'log-y', 'stacked'].map((id) =>
      Object.assign(document.createElement('input'), { type: 'checkbox', id }),
    );
    for (const box of [this.logX, this.logY])
      box.addEventListener('change', () => {
        this.setByHand = true;
        this.draw();
      });
    this.stacked.checked = true;
    this.stacked.addEventListener('change', () => this.draw());
    const controls = document.createElement('div');
    controls.className = 'controls';
    const switched = (text, box) => {
      const label = Page.labelled('', box);
      label.className = 'switch';
      label.append(text);
      return label;
    };
    const scales = document.createElement('span');
    this.stacking = switched('stacked', this.stacked);
    scales.append(switched('log x', this.logX), switched('log y', this.logY), this.stacking);
    controls.append(
      Page.labelled('Quantity', this.quantity),
      Page.labelled('Over', this.axis),
      Page.labelled('Panels', this.panels),
      scales,
    );
    this.chart = new Chart(document.createElement('figure'), onPick);
    host.append(Page.heading('h2', 'Results'), controls, this.chart.host);
    this.setByHand = false;
  }

  show(data) {
    this.data = data;
    this.sweep = new Sweep(data);
    this.choices = this.sweep.choices();
    const { sweep } = this,
      isFirst = !this.axis.options.length,
      option = (one, i) => [String(i), Format.option(one.about)];
    Page.refill(
      this.quantity,
      this.choices.map((one, i) => [...option(one, i), one.group]),
    );
    Page.refill(this.axis, sweep.parameters.map(option));
    Page.refill(this.panels, [['usual', 'as fits'], ['none', 'none'], ...sweep.parameters.map(option)]);
    if (isFirst) this.axis.value = String(sweep.parameters.indexOf(sweep.usual));
    this.draw();
  }

  // Another quantity or axis: scales are again those that fit.
  renew() {
    this.setByHand = false;
    this.draw();
  }

  draw() {
    const { sweep } = this,
      choice = this.choices[Number(this.quantity.value)],
      axis = sweep.parameters[Number(this.axis.value)];
    const usual = sweep.usualPanels(axis, choice ? choice.indices.length : 1),
      chosen = this.panels.value;
    const by =
      chosen === 'usual'
        ? usual
        : chosen === 'none'
          ? []
          : [sweep.parameters[Number(chosen)]].filter((one) => one !== axis);
    if (!choice) {
      this.chart.show({ panels: [] });
      return;
    }
    const canStack = sweep.isSum(choice) && sweep.isAlone(axis, by),
      stacked = canStack && this.stacked.checked;
    this.stacking.hidden = choice.indices.length < 2;
    this.stacked.disabled = !canStack;
    const figure = sweep.figure(
      choice,
      axis,
      by,
      this.setByHand ? { x: this.logX.checked, y: this.logY.checked } : {},
      stacked,
    );
    this.logY.disabled = stacked;
    this.logX.checked = figure.x.log;
    this.logY.checked = figure.y.log;
    this.logX.disabled = !axis.numeric;
    const confidence = Format.rough(100 * this.data.target.confidence);
    const bars = `Bars are ${confidence} % intervals`;
    figure.caption = `${stacked ? `${bars} of the sum; parts below zero hang below it.` : `${bars}; lines only guide the eye.`}${
      figure.hasBand ? ' Bands: the tolerance around each mean.' : ''
    }${
      figure.kinds.includes('provisional')
        ? ' Provisional: the point is not decided yet, and its number may still change.'
        : ''
    }`;
    this.chart.show(figure);
  }
}
