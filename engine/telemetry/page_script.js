"use strict";
(() => {
  const rows = JSON.parse(document.getElementById("rows").textContent);
  const times = rows.t, count = times.length;
  const whole = [times[0] ?? 0, Math.max(times[count - 1] ?? 0, (times[0] ?? 0) + 1e-3)];
  let range = whole, picked = -1;
  const zooms = [];  // ranges to return to

  // Elements, with attributes and content; text is never HTML.
  function make(name, attributes = {}, ...content) {
    const svg = /^(svg|g|path|line|rect|circle|text|title)$/.test(name);
    const space = "http" + (svg ? "://www.w3.org/2000/svg" : "://www.w3.org/1999/xhtml");
    const element = document.createElementNS(space, name);
    for (const [key, value] of Object.entries(attributes))
      if (value !== undefined) element.setAttribute(key, value);
    element.append(...content);
    return element;
  }
  const button = (text, act) => {
    const b = make("button", {type: "button"}, text);
    b.addEventListener("click", act);
    return b;
  };

  function digits(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return size >= 1e4 ? Math.round(value).toLocaleString("en").replaceAll(",", "\u202f") :
                         String(Number(value.toPrecision(size >= 1000 ? 4 : 3)));
  }
  const withUnit = (value, unit) =>
      unit.startsWith("%") ? digits(value) + " %" : digits(value) + " " + unit;
  function niceStep(span, steps) {
    const raw = Math.max(span, 1e-12) / steps, power = 10 ** Math.floor(Math.log10(raw));
    const ratio = raw / power;
    return power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
  }
  const tick = (value, step) => value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));

  // The first row at or after a time.
  function rowAt(time) {
    let low = 0, high = count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] < time)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }
  function nearestRow(time) {
    const row = Math.min(rowAt(time), count - 1);
    return row > 0 && time - times[row - 1] < times[row] - time ? row - 1 : row;
  }
  // Rows without numbers are not frames.
  const nameOf = row =>
      (rows.n.length ? "Frame " + rows.n[row] + " at " : "At ") + times[row].toFixed(2) + " s";

  // One figure.
  class Plot {
    constructor(figure) {
      this.figure = figure;
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.place = figure.querySelector(".drawing");
      this.readout = make("div", {class: "readout", hidden: ""});
      figure.append(this.readout);
      this.listen();
    }
    x(time) {
      return this.left + (time - range[0]) / (range[1] - range[0]) * (this.right - this.left);
    }
    y(value) {
      return this.bottom - Math.min(Math.max(value / this.top, 0), 1) * (this.bottom - this.high);
    }
    time(x) {
      return range[0] + (x - this.left) / (this.right - this.left) * (range[1] - range[0]);
    }

    // Rows that share a pixel, as one column each.
    columns(values, first, end) {
      const most = Math.max(1, Math.floor(this.right - this.left)), n = Math.min(end - first, most);
      const list = [];
      for (let k = 0; k < n; k++)
        list.push({low: Infinity, high: -Infinity, sum: 0, n: 0, x: 0});
      for (let row = end - 1; row >= first; row--) {
        const column = list[Math.floor((row - first) * n / (end - first))], value = values[row];
        column.x = this.x(times[row]);
        if (value === null) continue;
        column.low = Math.min(column.low, value);
        column.high = Math.max(column.high, value);
        column.sum += value;
        column.n++;
      }
      for (const column of list)
        column.mean = column.n ? column.sum / column.n : 0;
      return list;
    }
    path(columns, value, back) {
      let text = "";
      for (let k = 0; k < columns.length; k++) {
        if (!columns[k].n) continue;
        let end = k;
        while (end < columns.length && columns[end].n)
          end++;
        const part = columns.slice(k, end);
        const point = (column, of) =>
            column.x.toFixed(1) + "," + this.y(of(column)).toFixed(1) + " ";
        text += "M" + part.map(c => point(c, value)).join("");
        if (back)
          text += part.reverse().map(c => point(c, back)).join("") + "Z";
        else if (part.length === 1)
          text += "h.1";
        k = end;
      }
      return text;
    }
    draw() {
      const width = Math.max(this.place.clientWidth, 200), wide = width > 640;
      this.width = width;
      this.height = (this.data.small ? 130 : 220) + (wide ? 0 : -20);
      this.left = wide ? 58 : 44;
      this.right = width - (wide ? 120 : 8);
      this.high = 14;
      this.bottom = this.height - 36;
      const first = Math.max(rowAt(range[0]), 0), end = Math.min(rowAt(range[1] + 1e-9), count);
      const all = this.data.series.map(s => this.columns(s.v, first, end));
      const stacked = this.data.kind === "stacked";
      const full = range === whole || !this.data.zooms;
      this.top = full && this.data.top > 0 ? this.data.top : this.topOf(all, full);
      const svg = make("svg", {
        width,
        height: this.height,
        viewBox: `0 0 ${width} ${this.height}`,
        role: "img",
        "aria-label": this.data.title
      });
      if (rows.warmup > range[0] && count) {
        const right = this.x(Math.min(rows.warmup, range[1]));
        svg.append(make(
            "rect", {
              class: "warmup",
              x: this.left,
              y: this.high,
              width: Math.max(0, right - this.left),
              height: this.bottom - this.high
            },
            make("title", {}, "warm-up, excluded from statistics")));
      }
      this.axes(svg, wide);
      if (stacked)
        this.stack(svg, all);
      else
        all.forEach((columns, i) => {
          const colour = this.data.series[i].colour, peaks = this.data.kind === "peaks";
          svg.append(make("path", {
            class: "band fill" + colour,
            d: this.path(columns, c => c.high, peaks ? () => 0 : c => c.low)
          }));
          svg.append(make("path", {
            class: "line stroke" + colour,
            d: this.path(columns, peaks ? c => c.high : c => c.mean)
          }));
        });
      this.marks(svg, first, end);
      for (const level of this.data.levels)
        if (level.value <= this.top) this.level(svg, level, wide);
      this.cursor =
          make("line", {class: "cursor", visibility: "hidden", y1: this.high, y2: this.bottom});
      this.selection = make("rect", {
        class: "selection",
        visibility: "hidden",
        y: this.high,
        height: this.bottom - this.high
      });
      svg.append(this.selection, this.cursor);
      if (picked >= 0 && times[picked] >= range[0] && times[picked] <= range[1]) {
        const x = this.x(times[picked]);
        svg.append(
            make("line", {class: "picked", x1: x, x2: x, y1: this.high, y2: this.bottom}),
            make("circle", {class: "pin", cx: x, cy: this.high, r: 4}));
      }
      this.place.replaceChildren(svg);
    }
    topOf(all, full) {
      let top = 0;
      if (full)
        for (const level of this.data.levels)
          top = Math.max(top, level.value);
      if (this.data.kind === "stacked") {
        for (let k = 0; k < (all[0] ?? []).length; k++)
          top = Math.max(top, all.reduce((sum, columns) => sum + columns[k].mean, 0));
      } else
        for (const columns of all)
          for (const c of columns)
            if (c.n) top = Math.max(top, c.high);
      return top > 0 ? top * 1.08 : 1;
    }
    axes(svg, wide) {
      const step = niceStep(this.top, this.data.small ? 3 : 5);
      for (let value = 0; value <= this.top * 1.0001; value += step)
        svg.append(
            make("line", {
              class: "grid",
              x1: this.left,
              x2: this.right,
              y1: this.y(value),
              y2: this.y(value)
            }),
            make(
                "text", {x: this.left - 7, y: this.y(value) + 4, "text-anchor": "end"},
                tick(value, step)));
      const xStep = niceStep(range[1] - range[0], wide ? 12 : 5);
      for (let t = Math.ceil(range[0] / xStep) * xStep; t <= range[1] + 1e-9; t += xStep)
        svg.append(make(
            "text", {x: this.x(t), y: this.bottom + 17, "text-anchor": "middle"}, tick(t, xStep)));
      svg.append(
          make(
              "text",
              {x: (this.left + this.right) / 2, y: this.bottom + 33, "text-anchor": "middle"},
              "flight time (s)"),
          make(
              "text", {
                transform: `translate(12 ${(this.high + this.bottom) / 2}) rotate(-90)`,
                "text-anchor": "middle"
              },
              this.data.unit));
    }
    stack(svg, all) {
      const below = (all[0] ?? []).map(() => 0);
      all.forEach((columns, i) => {
        columns.forEach((c, k) => {
          c.from = below[k];
          c.to = below[k] += c.mean;
        });
        svg.append(make("path", {
          class: "stack fill" + this.data.series[i].colour,
          d: this.path(columns, c => c.to, c => c.from)
        }));
      });
    }
    // Frames that timing statistics exclude, and the game's marks.
    marks(svg, first, end) {
      let path = "", last = -1;
      const seen = list => Object.keys(list ?? {}).filter(row => row >= first && row < end);
      for (const row of seen(rows.apart)) {
        const x = Math.round(this.x(times[row]));
        if (x !== last) path += `M${x} ${this.bottom}v-8`;
        last = x;
      }
      const line = (style, d, text) =>
          svg.append(make("path", {class: style, d}, make("title", {}, text)));
      if (path) line("mark", path, "excluded from timing statistics");
      const marks = seen(rows.marks), name = row => marks.length < 20 ? rows.marks[row] : "";
      for (const row of marks) {
        const x = this.x(times[row]);
        line("event", `M${x} ${this.high}V${this.bottom}`, rows.marks[row]);
        svg.append(make("text", {class: "event", x: x + 3, y: this.high + 9}, name(row)));
      }
    }
    level(svg, level, wide) {
      const y = this.y(level.value);
      svg.append(
          make("line", {class: "level", x1: this.left, x2: this.right, y1: y, y2: y}),
          make(
              "text", {
                class: "level",
                x: wide ? this.right + 6 : this.right,
                y: level.below ? y + 12 : y - 3,
                "text-anchor": wide ? "start" : "end"
              },
              level.label));
    }
    // Values under the pointer, selecting a range, and picking a row.
    listen() {
      let from = null;
      const at = event => Math.min(
          Math.max(event.clientX - this.place.getBoundingClientRect().left, this.left), this.right);
      this.place.addEventListener("pointerleave", () => {
        if (from === null) hover(null);
      });
      this.place.addEventListener("pointerdown", event => {
        if (event.button !== 0 || !count) return;
        from = at(event);
        try {
          this.place.setPointerCapture(event.pointerId);
        } catch (error) { /* not a real pointer */
        }
      });
      this.place.addEventListener("pointermove", event => {
        if (!count) return;
        hover(nearestRow(this.time(at(event))), this, event);
        if (from === null) return;
        this.selection.setAttribute("x", Math.min(from, at(event)));
        this.selection.setAttribute("width", Math.abs(at(event) - from));
        this.selection.setAttribute("visibility", "visible");
      });
      this.place.addEventListener("pointercancel", () => {
        from = null;
        this.draw();
      });
      this.place.addEventListener("pointerup", event => {
        if (from === null) return;
        const a = this.time(Math.min(from, at(event))), b = this.time(Math.max(from, at(event)));
        const dragged = Math.abs(at(event) - from) > 6;
        from = null;
        if (!dragged)
          pick(nearestRow(a));
        else
          zoom([a, b]);
      });
    }
    say(row, event) {
      const lines = [make("b", {}, nameOf(row))];
      if (rows.apart[row] !== undefined)
        lines.push(make("div", {}, "excluded: " + rows.apart[row]));
      if (rows.marks?.[row] !== undefined) lines.push(make("div", {}, "mark: " + rows.marks[row]));
      for (const series of this.data.series)
        if (series.v[row] !== null)
          lines.push(make("div", {}, series.name + ": " + withUnit(series.v[row], this.data.unit)));
      this.readout.replaceChildren(...lines);
      this.readout.hidden = false;
      const outer = this.figure.getBoundingClientRect();
      let left = event.clientX - outer.left + 16;
      if (left + this.readout.offsetWidth > outer.width - 8) left -= this.readout.offsetWidth + 32;
      this.readout.style.left = Math.max(left, 4) + "px";
      this.readout.style.top = event.clientY - outer.top + 14 + "px";
    }
  }

  const plots = [...document.querySelectorAll("figure.plot")].map(figure => new Plot(figure));

  function hover(row, plot, event) {
    for (const each of plots) {
      if (each !== plot) each.readout.hidden = true;
      if (!each.cursor) continue;
      each.cursor.setAttribute("visibility", row === null ? "hidden" : "visible");
      if (row === null) continue;
      each.cursor.setAttribute("x1", each.x(times[row]));
      each.cursor.setAttribute("x2", each.x(times[row]));
    }
    if (row !== null) plot.say(row, event);
  }
  // At least ten rows stay visible.
  function zoom(wanted) {
    let first = rowAt(wanted[0]), end = rowAt(wanted[1]);
    while (end - first < Math.min(10, count)) {
      first = Math.max(first - 1, 0);
      end = Math.min(end + 1, count);
    }
    zooms.push(range);
    show([times[first], Math.max(times[end - 1], times[first] + 1e-3)]);
  }
  function show(wanted) {
    range = wanted;
    draw();
  }

  // Times of series `i` of the first plot in view, after the warm-up, in ascending order.
  function timesInView(i) {
    const values = plots[0]?.data.series[i]?.v ?? [], list = [];
    for (let row = 0; row < count; row++)
      if (values[row] !== null && times[row] >= range[0] && times[row] <= range[1] + 1e-9 &&
          times[row] >= rows.warmup)
        list.push(values[row]);
    return list.sort((a, b) => a - b);
  }
  function percentile(sorted, p) {
    const h = p * (sorted.length - 1), low = Math.floor(h);
    return sorted[low] + (h - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
  }
  const kPercentiles =
      [["p50", .5, 2], ["p90", .9, 10], ["p95", .95, 20], ["p99", .99, 100], ["p99.9", .999, 1000]];

  function drawDistribution() {
    const figure = document.getElementById("distribution");
    if (!figure || !plots.length) return;
    const place = figure.querySelector(".drawing"),
          series = plots[0].data.series.slice(0, rows.times);
    const sorted = series.map((_, i) => timesInView(i)),
          most = Math.max(...sorted.map(s => s.length));
    const note = figure.querySelector(".note");
    if (most < 2) {
      place.replaceChildren();
      note.textContent = "Fewer than two timed frames are visible.";
      figure.querySelector(".percentiles").replaceChildren();
      return;
    }
    const low = Math.min(...sorted.map(s => s[0] ?? Infinity));
    const high = Math.max(
        ...sorted.map(s => s.length ? Math.min(s.at(-1), 1.5 * percentile(s, .99)) : 0),
        low + 1e-3);
    const width = Math.max(place.clientWidth, 200), height = 200, left = 44, right = width - 12,
          top = 18, bottom = 162;
    const bins = Math.max(8, Math.min(60, Math.floor((right - left) / 14)));
    const x = ms => left + (ms - low) / (high - low) * (right - left);
    const counts = sorted.map(list => {
      const c = Array(bins).fill(0);
      for (const ms of list)
        if (ms <= high) c[Math.min(bins - 1, Math.floor((ms - low) / (high - low) * bins))]++;
      return c;
    });
    const tallest = Math.max(...counts.flat()), svg = make("svg", {
                                                  width,
                                                  height,
                                                  viewBox: `0 0 ${width} ${height}`,
                                                  role: "img",
                                                  "aria-label": "histogram of frame times"
                                                });
    const y = n => bottom - n / tallest * (bottom - top), step = Math.max(niceStep(tallest, 4), 1);
    for (let n = 0; n <= tallest; n += step)
      svg.append(
          make("line", {class: "grid", x1: left, x2: right, y1: y(n), y2: y(n)}),
          make("text", {x: left - 7, y: y(n) + 4, "text-anchor": "end"}, String(n)));
    const xStep = niceStep(high - low, width > 640 ? 12 : 5);
    for (let ms = Math.ceil(low / xStep) * xStep; ms <= high + 1e-9; ms += xStep)
      svg.append(
          make("text", {x: x(ms), y: bottom + 17, "text-anchor": "middle"}, tick(ms, xStep)));
    const wide = (right - left) / bins;
    const style = (counts.length > 1 ? "band " : "stack ") + "fill";
    const edge = k => digits(low + k * (high - low) / bins);
    const bar = (n, k, colour) => make(
        "rect", {
          class: style + colour,
          x: left + k * wide + .5,
          width: wide - 1,
          y: y(n),
          height: bottom - y(n)
        },
        make("title", {}, `${n} frame${n === 1 ? "" : "s"} of ${edge(k)} to ${edge(k + 1)} ms`));
    counts.forEach(
        (list, i) => list.forEach((n, k) => n && svg.append(bar(n, k, series[i].colour))));
    if (counts.length === 1)
      for (const [name, p, needed] of kPercentiles) {
        if (sorted[0].length < needed || !["p50", "p99"].includes(name)) continue;
        const at = x(percentile(sorted[0], p));
        svg.append(
            make("line", {class: "p", x1: at, x2: at, y1: top - 4, y2: bottom}),
            make("text", {class: "level", x: at, y: top - 6, "text-anchor": "middle"}, name));
      }
    svg.append(make(
        "text", {x: (left + right) / 2, y: bottom + 33, "text-anchor": "middle"},
        "frame time (ms)"));
    place.replaceChildren(svg);
    figure.querySelector(".legend").replaceChildren(
        ...(series.length > 1 ?
                series.map(s => make("span", {}, make("i", {class: "swatch" + s.colour}), s.name)) :
                []));
    const table = make("table"), cell = (tag, text) => make(tag, {}, text);
    table.append(make(
        "tr", {}, cell("th", "ms"), ...kPercentiles.map(p => cell("th", p[0])),
        cell("th", "slowest"), cell("th", "mean")));
    series.forEach(
        (s, i) => table.append(make(
            "tr", {}, cell("th", s.name),
            ...kPercentiles.map(
                ([, p, needed]) => cell(
                    "td", sorted[i].length >= needed ? digits(percentile(sorted[i], p)) : "–")),
            cell("td", digits(sorted[i].at(-1))),
            cell("td", digits(sorted[i].reduce((a, b) => a + b, 0) / sorted[i].length)))));
    figure.querySelector(".percentiles").replaceChildren(table);
    const beyond = Math.max(...sorted.map(s => s.filter(ms => ms > high).length));
    note.textContent = `${most} frames in view, without warm-up and excluded frames.` +
        (beyond ? ` ${beyond} slower than ${digits(high)} ms ${
                      beyond === 1 ? "is" : "are"} off the scale.` :
                  "") +
        (rows.every > 1 ? ` Each is the slowest of ${
                              rows.every}: percentiles are higher than those of all frames.` :
                          "");
  }

  // The slowest frames in view, below the first plot.
  function drawSlowest() {
    if (!plots.length || !rows.times) return;
    const series = plots[0].data.series.slice(0, rows.times), list = [];
    const values = times.map((_, row) => Math.max(...series.map(s => s.v[row] ?? -1)));
    for (let row = 0; row < count; row++)
      if (values[row] >= 0 && times[row] >= Math.max(range[0], rows.warmup) &&
          times[row] <= range[1] + 1e-9)
        list.push(row);
    list.sort((a, b) => values[b] - values[a]);
    let place = plots[0].figure.querySelector(".slowest");
    if (!place) {
      place = make("div", {class: "slowest"});
      plots[0].place.after(place);
    }
    place.replaceChildren(
        "Slowest frames:",
        ...list.slice(0, 5).map(
            row => button(`${rows.n[row]} (${digits(values[row])} ms)`, () => pick(row))));
    place.hidden = !list.length;
  }

  const panel = document.getElementById("row");
  function table(style, lines) {
    const t = make("table", {class: style});
    for (const line of lines)
      t.append(line);
    return t;
  }
  function pick(row) {
    picked = row;
    document.body.classList.toggle("open", row >= 0);
    panel.hidden = row < 0;
    if (row >= 0) fill(row);
    for (const plot of plots)
      plot.draw();
  }
  // True if several plots have a series of this name.
  const shared = name =>
      plots.filter(p => p.data.kind !== "stacked" && p.data.series.some(s => s.name === name))
          .length > 1;
  function fill(row) {
    const line = (name, text) => make("tr", {}, make("th", {}, name), make("td", {}, text));
    const figures = [];
    if (rows.apart[row] !== undefined)
      figures.push(line("excluded", rows.apart[row] + ": not in timing statistics"));
    for (const plot of plots)
      if (plot.data.kind !== "stacked")
        for (const s of plot.data.series)
          if (s.v[row] !== null)
            figures.push(line(
                shared(s.name) ? s.name + ": " + plot.data.title : s.name,
                withUnit(s.v[row], plot.data.unit)));
    for (const f of rows.figures)
      if (f.v[row] !== null) figures.push(line(f.name, withUnit(f.v[row], f.unit)));
    const columns = make(
        "div", {class: "columns"}, make("div", {}, make("h3", {}, "Figures"), table("", figures)));
    const parts = rows.parts.filter(p => p.v[row] > 0).sort((a, b) => b.v[row] - a.v[row]);
    const longest = parts[0]?.v[row] ?? 1;
    if (parts.length)
      columns.append(make(
          "div", {}, make("h3", {}, "Time by part, slowest first"),
          table(
              "bars",
              parts.slice(0, 8).map(
                  p => make(
                      "tr", p.name.includes("waiting") ? {class: "wait"} : {},
                      make("td", {}, p.name),
                      make(
                          "td", {},
                          make("div", {class: "bar", style: `width:${100 * p.v[row] / longest}%`})),
                      make("td", {}, withUnit(p.v[row], p.unit)))))));
    if (rows.pictures[row] !== undefined) {
      const name = rows.pictures[row], picture = make("img", {alt: "the image of this frame"});
      const box = make("div", {}, make("h3", {}, "Picture: " + name), picture);
      picture.addEventListener(
          "error",
          () => picture.replaceWith(make("p", {class: "note"}, "The image file is missing.")));
      picture.setAttribute("src", encodeURIComponent(name));
      columns.append(box);
    } else if (Object.keys(rows.pictures).length) {
      const nearest = Object.keys(rows.pictures)
                          .map(Number)
                          .reduce((a, b) => Math.abs(b - row) < Math.abs(a - row) ? b : a);
      columns.append(make(
          "div", {}, make("h3", {}, "Image"),
          button("Nearest image: frame " + rows.n[nearest], () => pick(nearest))));
    }
    panel.replaceChildren(make(
        "div", {class: "inner"},
        make(
            "header", {}, make("b", {}, nameOf(row)),
            button("‹ previous", () => pick(Math.max(row - 1, 0))),
            button("next ›", () => pick(Math.min(row + 1, count - 1))),
            button("Close", () => pick(-1))),
        columns));
  }
  document.addEventListener("keydown", event => {
    if (picked < 0) return;
    if (event.key === "ArrowLeft") pick(Math.max(picked - 1, 0));
    if (event.key === "ArrowRight") pick(Math.min(picked + 1, count - 1));
    if (event.key === "Escape") pick(-1);
  });

  function draw() {
    for (const plot of plots)
      plot.draw();
    drawDistribution();
    drawSlowest();
    const shown = rowAt(range[1] + 1e-9) - rowAt(range[0]);
    document.getElementById("range").textContent =
        `${range[0].toFixed(2)} to ${range[1].toFixed(2)} s, ${shown} ` +
        (rows.every > 1 ? `of each ${rows.every} frames` :
             rows.n.length ? "frames" :
                             "values");
    document.getElementById("whole").disabled = document.getElementById("out").disabled =
        range === whole;
  }
  document.getElementById("whole").addEventListener("click", () => {
    zooms.length = 0;
    show(whole);
  });
  document.getElementById("out").addEventListener("click", () => show(zooms.pop() ?? whole));
  document.querySelector(".tools").hidden = !count;
  let width = 0;
  addEventListener("resize", () => {
    if (innerWidth !== width) {
      width = innerWidth;
      draw();
    }
  });
  draw();
})();
