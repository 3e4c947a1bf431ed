// Curves over time, or over another quantity: panels below each other, with one horizontal axis.
// Charts of a group have their zoom and their cursor in common.
import uPlot from "uplot";
import { makeWhenSeen } from "./seen.js";
import { colour, isPaper, onTheme } from "./theme.js";

/** How a curve looks by what it is; others have the colours of a palette in turn, with dashes. */
const LOOKS = {
  measured: { colour: "measured", width: 1.6 },
  computed: { colour: "computed", width: 1.6, dash: [6, 4] },
  before: { colour: "before", width: 1.2 },
  residual: { colour: "quiet", width: 1.2 },
  faint: { colour: "faint", width: 1 },
  points: { colour: "measured", points: true },
  law: { colour: "computed", points: true },
};
const PALETTE = 6;
/** So that curves are told apart without their colours, too. */
const DASHES = [undefined, [7, 4], [2, 3], [10, 3, 2, 3], [5, 2], [1, 5]];
/** Of so many curves the one below the cursor stands out. */
const MANY = 4;
/** Scales of panels that are lower have marks that stand closer [px]. */
const LOW = 130;
/** How much is seen through a band: the last two digits of its colour. */
const BAND = "55";
const PAPER_WIDTH = 640;

const groups = new Map();

function group(name) {
  if (!groups.has(name)) groups.set(name, { plots: [], isBusy: false, full: null });
  return groups.get(name);
}

/** The other charts of a group show the same part of the axis. */
function link(own, plot) {
  if (own.isBusy) return;
  own.isBusy = true;
  const { min, max } = plot.scales.x;
  for (const other of own.plots) if (other !== plot) other.setScale("x", { min, max });
  own.isBusy = false;
}

function shown(value) {
  if (value === null || value === undefined) return "\u2013";
  return String(Number(value.toPrecision(4)));
}

/** A mark of a scale: long ones would reach into its name. */
function mark(value) {
  const isLong = value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5);
  return isLong ? Number(value.toPrecision(4)).toExponential() : shown(value);
}

function lookOf(curve, place) {
  const at = place % PALETTE;
  return LOOKS[curve.look] ?? { colour: `c${at}`, width: 1.4, dash: DASHES[at] };
}

/** The curves of a panel: of one that chatters its least and its greatest, with what is between. */
function lines(panel) {
  const all = [];
  const bands = [];
  panel.curves.forEach((curve, place) => {
    const look = lookOf(curve, place);
    if (!curve.band) {
      all.push({ name: curve.name, look, y: curve.y });
      return;
    }
    // the first series is the axis
    const at = all.length + 1;
    const edge = { ...look, width: 0.8, dash: undefined };
    all.push({ name: `${curve.name}, greatest`, look: edge, y: curve.band.high });
    all.push({ name: `${curve.name}, least`, look: edge, y: curve.band.low });
    bands.push({ series: [at, at + 1], fill: () => `${colour(look.colour)}${BAND}` });
  });
  return { all, bands };
}

function series({ name, look }) {
  const stroke = () => colour(look.colour);
  return {
    label: name,
    class: look === LOOKS.faint ? "faint" : undefined,
    stroke,
    width: look.width ?? 0,
    // where it is, not at the nearest pixel: a slope has no steps
    pxAlign: 0,
    dash: look.dash,
    paths: look.points ? () => null : undefined,
    points: look.points ? { show: true, size: 3, fill: stroke } : { show: false },
    value: (_, value) => shown(value),
  };
}

function axis(label, isLeft, height) {
  return {
    label,
    labelSize: isLeft ? 20 : 18,
    labelFont: "12px system-ui, sans-serif",
    font: "11px system-ui, sans-serif",
    size: isLeft ? 58 : 32,
    stroke: () => colour("quiet"),
    grid: { stroke: () => colour("rule"), width: 1 },
    ticks: { stroke: () => colour("rule"), width: 1 },
    space: !isLeft ? 60 : height < LOW ? 14 : 28,
    values: (plot, ticks) => {
      const words = ticks.map(tick => (tick === null ? "" : mark(tick)));
      if (isLeft) plot.root.dataset.marks = words.filter(Boolean).length;
      return words;
    },
  };
}

/** Parts of the axis that stand out. */
function shade(plot, windows) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.fillStyle = colour("marked");
  for (const [from, to] of windows ?? []) {
    const ends = [from, to].map(x => plot.valToPos(x, "x", true));
    const [left, right] = ends.map(x => Math.min(Math.max(x, bbox.left), bbox.left + bbox.width));
    if (right > left) ctx.fillRect(left, bbox.top, right - left, bbox.height);
  }
  ctx.restore();
}

/** Lines of a logarithmic scale stand at powers of ten alone, if there are two of them. */
function powers(_, ticks) {
  const isPower = tick => Math.abs(Math.log10(tick) - Math.round(Math.log10(tick))) < 1e-9;
  const isLong = ticks.filter(isPower).length > 1;
  return ticks.map(tick => (!isLong || isPower(tick) ? tick : null));
}

/** What differs by less rests: its rounding is not drawn as if it were a signal. */
const LEAST = 1e-9;

function range(plot, low, high) {
  if (low === null || high === null) return [low, high];
  const rests = high - low < Math.max(LEAST, 1e-6 * Math.max(Math.abs(low), Math.abs(high)));
  const half = Math.max(0.5 * Math.abs(low), 0.5);
  return rests ? [low - half, high + half] : uPlot.rangeNum(low, high, 0.1, true);
}

function options(data, panel, { all, bands }, isLast, own, box, width) {
  const many = panel.curves.length > MANY;
  const left = axis(panel.label, true, panel.height);
  if (panel.log) for (const lines of [left, left.grid, left.ticks]) lines.filter = powers;
  return {
    width,
    height: panel.height + (isLast ? 50 : 24),
    padding: [10, 12, isLast ? 0 : 8, 0],
    scales: { x: { time: false }, y: panel.log ? { distr: 3 } : { range } },
    axes: [isLast ? axis(data.x_label, false) : { ...axis("", false), label: undefined, size: 14,
      values: (_, ticks) => ticks.map(() => "") }, left],
    series: [
      { label: data.x_name, value: (_, value) => shown(value) },
      ...all.map(series),
    ],
    bands,
    legend: { mount: (_, table) => box.append(table) },
    // of many curves the one below the cursor stands out
    focus: { alpha: many ? 0.2 : 1 },
    cursor: {
      y: false,
      focus: { prox: many ? 24 : -1 },
      drag: { x: true, y: false },
      sync: {
        key: data.group,
        setSeries: false,
        filters: { pub: type => type === "mousemove" || type === "mouseleave" },
      },
    },
    hooks: {
      drawClear: [plot => shade(plot, data.windows)],
      setScale: [(plot, scale) => { if (scale === "x") link(own, plot); }],
    },
  };
}

function zoom(own, plot, factor, shift) {
  const { min, max } = plot.scales.x;
  const [first, last] = own.full;
  const [half, middle] = [(factor * (max - min)) / 2, (min + max) / 2 + shift * (max - min)];
  const range = { min: Math.max(first, middle - half), max: Math.min(last, middle + half) };
  if (range.max > range.min) plot.setScale("x", range);
}

/** The keys of a chart: closer, further, along, all. */
function keys(own, plot) {
  return event => {
    const [min, max] = own.full;
    const acts = {
      "+": () => zoom(own, plot, 0.5, 0),
      "-": () => zoom(own, plot, 2, 0),
      ArrowLeft: () => zoom(own, plot, 1, -0.25),
      ArrowRight: () => zoom(own, plot, 1, 0.25),
      0: () => plot.setScale("x", { min, max }),
    };
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  };
}

function drawChart(figure) {
  const data = JSON.parse(figure.querySelector("script[type='application/json']").textContent);
  const room = figure.querySelector(".plot");
  const own = group(data.group);
  const x = data.x;
  own.full ??= [x[0], x[x.length - 1]];
  own.full = [Math.min(own.full[0], x[0]), Math.max(own.full[1], x[x.length - 1])];
  // paper is not as wide as a screen, and what is in a tab has no width there
  const width = () => (isPaper() ? PAPER_WIDTH : Math.max(200, room.clientWidth));
  // a chart that is come to later shows what the others of its group show
  const shown = own.plots[0] && { min: own.plots[0].scales.x.min, max: own.plots[0].scales.x.max };
  const plots = data.panels.map((panel, place) => {
    const legend = document.createElement("div");
    // panels of a chart have their time in common: one of them tells it
    legend.className = place === 0 ? "legend" : "legend further";
    room.append(legend);
    const isLast = place === data.panels.length - 1;
    const curves = lines(panel);
    const given = options(data, panel, curves, isLast, own, legend, width());
    const plot = new uPlot(given, [x, ...curves.all.map(line => line.y)], room);
    own.plots.push(plot);
    return plot;
  });
  if (shown) plots[0].setScale("x", shown);
  room.addEventListener("keydown", keys(own, plots[0]));
  const resize = to => plots.forEach(plot => {
    if (plot.width !== to) plot.setSize({ width: to, height: plot.height });
  });
  new ResizeObserver(() => {
    if (room.clientWidth > 0 && !isPaper()) resize(width());
  }).observe(room);
  onTheme(() => {
    resize(width());
    plots.forEach(plot => plot.redraw(false, true));
  });
}

export function drawCharts(root) {
  makeWhenSeen(root.querySelectorAll("figure.chart"), "charts", drawChart);
}
