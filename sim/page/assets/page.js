(() => {
  'use strict';

  const kPrintWidth = 680;
  const root = document.documentElement;
  const panels = [];
  let linking = false;

  const colour = (name) => getComputedStyle(root).getPropertyValue('--' + name).trim();

  const paint = (data) => ({
    colors: data.styles.map(colour),
    gridLineColor: colour('grid'),
    axisLineColor: colour('rule'),
  });

  // The measured curve is broad, so that a simulated one on top of it leaves both visible.
  const pen = (style) => ({
    strokePattern: style === 'before' ? [7, 3] : null,
    strokeWidth: style === 'measured' ? 3 : 1.6,
  });

  const number = (value, digits) => {
    const text = String(Number(value.toPrecision(digits)));
    return text.replace('-', '\u2212');
  };

  const rows = (data) => data.values[0].map((_, i) => [
    data.time ? data.time[i] : Number((data.start + i * data.step).toPrecision(12)),
    ...data.values.map((values) => values[i]),
  ]);

  // Ticks at 1, 2 or 5 times a power of ten, all inside the range.
  const ticker = (spacing) => (low, high, pixels) => {
    const rough = (high - low) * spacing / pixels;
    const decade = 10 ** Math.floor(Math.log10(rough));
    const step = decade * ([1, 2, 5].find((factor) => factor * decade >= 0.8 * rough) || 10);
    const ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
      ticks.push({v: i * step, label: number(i * step, 6)});
    }
    return ticks;
  };

  // Values of every panel of the group at the hovered time.
  const point = (panel, row) => {
    panel.outputs.forEach((output, i) => {
      const value = row === null ? undefined : panel.graph.getValue(row, i + 1);
      output.textContent = Number.isFinite(value) ? number(value, 5) : row === null ? '' : '\u2013';
    });
    const time = row === null ? '' : ' = ' + number(panel.graph.getValue(row, 0), 6) + ' s';
    panel.time.textContent = 'time' + (time || ' [s]');
  };

  const nearest = (graph, time) => {
    let low = 0;
    let high = graph.numRows() - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (graph.getValue(middle, 0) <= time) low = middle; else high = middle;
    }
    return time - graph.getValue(low, 0) <= graph.getValue(high, 0) - time ? low : high;
  };

  const linked = (panel) => panels.filter(
      (other) => other.graph && (other === panel || (panel.data.group > 0 &&
                                                     other.data.group === panel.data.group)));

  const hover = (panel, row) => linked(panel).forEach((other) => {
    if (row === null) {
      other.graph.clearSelection();
      return point(other, null);
    }
    const time = panel.graph.getValue(row, 0);
    const there = other === panel ? row : nearest(other.graph, time);
    if (other !== panel) other.graph.setSelection(there);
    return point(other, there);
  });

  const quietly = (action) => {
    if (linking) return;
    linking = true;
    action();
    linking = false;
  };

  const zoom = (panel) => quietly(() => {
    const dateWindow = panel.graph.isZoomed('x') ? panel.graph.xAxisRange() : null;
    linked(panel).filter((other) => other !== panel).forEach((other) => {
      other.graph.updateOptions({dateWindow});
    });
  });

  const draw = (panel) => {
    if (panel.graph || panel.chart.offsetWidth === 0) return;
    const {data, chart} = panel;
    const table = rows(data);
    const names = data.styles.map((_, i) => 's' + i);
    const options = {
      ...paint(data),
      labels: ['time', ...names],
      series: Object.fromEntries(names.map((name, i) => [name, pen(data.styles[i])])),
      legend: 'never',
      pointSize: 2.5,
      highlightCircleSize: 3.5,
      xRangePad: 4,
      yRangePad: 8,
      axes: {
        x: {ticker: ticker(100)},
        y: {ticker: ticker(34), axisLabelWidth: 58},
      },
      highlightCallback: (event, x, points, row) => hover(panel, row),
      unhighlightCallback: () => quietly(() => hover(panel, null)),
      drawCallback: (graph, initial) => { if (!initial) zoom(panel); },
    };
    const first = table[0][0];
    if (table[table.length - 1][0] === first) options.dateWindow = [first - 0.5, first + 0.5];
    panel.graph = new Dygraph(chart, table, options);
  };

  const repaint = () => quietly(
      () => panels.forEach((panel) => panel.graph && panel.graph.updateOptions(paint(panel.data))));

  document.querySelectorAll('.series').forEach((figure) => panels.push({
    data: JSON.parse(figure.querySelector('script').textContent),
    chart: figure.querySelector('.chart'),
    outputs: figure.querySelectorAll('output'),
    time: figure.querySelector('.x-title'),
    graph: null,
  }));
  panels.forEach(draw);

  const hint = document.createElement('div');
  hint.className = 'note hint';
  hint.textContent = 'Drag to zoom, shift and drag to pan, double-click to reset. ' +
      'Panels of one log move together.';
  panels[0].chart.closest('figure').append(hint);

  // A folded panel has no width yet; it is drawn when it unfolds.
  document.addEventListener('toggle', () => panels.forEach(draw), true);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', repaint);

  let opened = [];
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll('details:not([open])')];
    opened.forEach((details) => { details.open = true; });
    root.classList.add('printing');
    panels.forEach(draw);
    repaint();
    quietly(() => panels.forEach((panel) => {
      if (panel.chart.offsetWidth > kPrintWidth) {
        panel.graph.resize(kPrintWidth, panel.chart.clientHeight);
      }
    }));
  });
  addEventListener('afterprint', () => {
    root.classList.remove('printing');
    opened.forEach((details) => { details.open = false; });
    panels.forEach((panel) => { panel.chart.style.width = ''; });
    quietly(() => panels.forEach((panel) => panel.graph && panel.graph.resize()));
    repaint();
  });
})();
