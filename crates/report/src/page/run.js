// Looks closer at a stretch of time in all diagrams at once, moves one cursor through them and the spot over the wall, and plays the run.
// Everything is on the page without this too. Of each curve `data-v` has the values: see `cells.rs`.
(() => {
  const areas = [...document.querySelectorAll('.area')], spot = document.getElementById('spot');
  const player = document.getElementById('player');
  if (!track.length || !areas.length || !spot) return;
  const [play, slider, readout, pace, all] = ['play', 'time', 'readout', 'pace', 'whole'].map(id => document.getElementById(id));
  const SIDE = 1000, LEAST_S = 0.01, HEIGHT = 4000;

  // a byte of the text is six bits of a stream of bytes; these are numbers of seven bits a byte, the low ones first
  const numbers = text => {
    const bytes = atob(text), out = [];
    for (let i = 0; i < bytes.length;) {
      let value = 0, place = 1, byte;
      do { byte = bytes.charCodeAt(i++); value += (byte & 127) * place; place *= 128; } while (byte > 127);
      out.push(value);
    }
    return out;
  };
  // lows and highs of a curve's cells, NaN where it has none
  const cells = path => {
    const pairs = path.dataset.pairs !== undefined, list = numbers(path.dataset.v), low = [], high = [];
    let last = 0;
    for (let i = 0; i < list.length;) {
      const code = list[i++];
      if (code === 0) { low.push(NaN); high.push(NaN); continue; }
      const step = code - 1;
      last += step % 2 ? -(step + 1) / 2 : step / 2;
      low.push(last);
      high.push(pairs ? last + list[i++] : last);
    }
    return { low, high };
  };
  const plots = areas.map(area => {
    const svg = area.querySelector('svg'), grid = svg.querySelector('.grid'), drawn = grid.getAttribute('d');
    const marks = area.parentElement.querySelector('.x-marks');
    const curves = [...svg.querySelectorAll('[data-v]')].map(path => ({
      path, whole: path.getAttribute('d'), mean: path.dataset.band === undefined ? null : path.nextElementSibling,
    }));
    curves.forEach(curve => { if (curve.mean) curve.wholeMean = curve.mean.getAttribute('d'); });
    const labels = [...area.querySelectorAll('.labels b')].map(b => ({ b, from: +b.dataset.from, to: +b.dataset.to }));
    const shift = +area.dataset.shift, from = +area.dataset.from + shift, to = +area.dataset.to + shift;
    return { area, svg, grid, drawn, marks, words: marks.innerHTML, curves, labels, from, to, shift };
  });
  const first = Math.min(...plots.map(p => p.from)), end = Math.max(...plots.map(p => p.to));
  let view = [first, end], now = first, playing = 0;
  const isWhole = () => view[0] === first && view[1] === end;
  const span = plot => isWhole() ? [plot.from, plot.to] : view;
  const share = (plot, t) => { const [a, b] = span(plot); return (t - a) / (b - a); };
  const timeAt = (plot, x) => {
    const box = plot.area.getBoundingClientRect(), [a, b] = span(plot);
    return a + Math.min(1, Math.max(0, (x - box.left) / box.width)) * (b - a);
  };

  // the curve between two shares of its cells: all of them, or the least and the greatest of each pixel
  const path = (curve, s0, s1, width) => {
    curve.cells ??= cells(curve.path);
    const { low, high } = curve.cells, most = low.length - 1;
    const from = Math.max(0, Math.floor(s0 * most) - 1), to = Math.min(most, Math.ceil(s1 * most) + 1);
    const each = Math.max(1, Math.floor((to - from) / width));
    const y = v => (SIDE * (1 - v / HEIGHT)).toFixed(1);
    let text = '', mean = '', pen = 'M', up = [], down = [];
    const close = () => { if (up.length) text += `M${up.join('L')}L${down.reverse().join('L')}Z`; up = []; down = []; pen = 'M'; };
    for (let i = from; i <= to; i += each) {
      let least = Infinity, greatest = -Infinity, sum = 0, n = 0;
      for (let k = i; k < Math.min(i + each, to + 1); k++) {
        if (!(low[k] <= high[k])) continue;
        least = Math.min(least, low[k]); greatest = Math.max(greatest, high[k]); sum += low[k] + high[k]; n += 2;
      }
      if (!n) { close(); continue; }
      const x = (SIDE * i / most).toFixed(4);
      if (curve.mean) {
        up.push(`${x} ${y(greatest)}`); down.push(`${x} ${y(least)}`); mean += `${pen}${x} ${y(sum / n)}`;
      } else {
        text += `${pen}${x} ${y(least)}` + (greatest > least ? `L${x} ${y(greatest)}` : '');
      }
      pen = 'L';
    }
    close();
    return [text, mean];
  };
  const ticks = (a, b, most) => {
    const power = 10 ** Math.floor(Math.log10((b - a) / most)), step = [1, 2, 5, 10].map(k => k * power).find(s => (b - a) / s <= most);
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), list = [];
    for (let k = Math.ceil(a / step - 1e-9); k * step <= b + 1e-9; k++) list.push([k * step, (k * step).toFixed(digits).replace('-', '−')]);
    return list;
  };
  const redraw = plot => {
    const whole = isWhole(), length = plot.to - plot.from;
    const [s0, s1] = span(plot).map(t => (t - plot.from) / length);
    plot.svg.setAttribute('viewBox', `${SIDE * s0} 0 ${SIDE * (s1 - s0)} ${SIDE}`);
    for (const curve of plot.curves) {
      const [d, mean] = whole ? [curve.whole, curve.wholeMean] : path(curve, s0, s1, plot.area.clientWidth);
      curve.path.setAttribute('d', d);
      if (curve.mean) curve.mean.setAttribute('d', mean);
    }
    if (whole) { plot.grid.setAttribute('d', plot.drawn); plot.marks.innerHTML = plot.words; } else {
      const list = ticks(view[0] - plot.shift, view[1] - plot.shift, 6);
      const at = t => (t + plot.shift - plot.from) / length;
      plot.grid.setAttribute('d', list.map(([t]) => `M${(SIDE * at(t)).toFixed(4)} 0V${SIDE}`).join('') +
        (plot.drawn.match(/M0 [\d.]+H\d+/g) ?? []).join(''));
      plot.marks.innerHTML = list.map(([t, text]) => `<span style="left:${100 * (at(t) - s0) / (s1 - s0)}%">${text}</span>`).join('');
    }
    for (const { b, from, to } of plot.labels) {
      const a = Math.max(from, s0), z = Math.min(to, s1), wide = (z - a) / (s1 - s0) * plot.area.clientWidth;
      b.style.left = 100 * ((a + z) / 2 - s0) / (s1 - s0) + '%';
      b.classList.toggle('narrow', !(wide >= 7 * b.textContent.length + 4));
    }
  };
  const look = (a, b) => {
    if (b - a < LEAST_S) { const middle = (a + b) / 2; [a, b] = [middle - LEAST_S / 2, middle + LEAST_S / 2]; }
    const length = Math.min(b - a, end - first);
    a = Math.min(Math.max(a, first), end - length);
    view = length >= end - first ? [first, end] : [a, a + length];
    all.disabled = isWhole();
    plots.forEach(redraw);
    show(now);
  };

  const row = t => {
    let low = 0, high = track.length - 1;
    while (low < high) { const mid = (low + high + 1) >> 1; if (track[mid][0] <= t) low = mid; else high = mid - 1; }
    return track[low];
  };
  const show = t => {
    now = Math.min(end, Math.max(first, t));
    for (const plot of plots) {
      const at = share(plot, now);
      plot.area.querySelector('.cursor').style.left = 100 * at + '%';
      plot.area.classList.toggle('on', at >= 0 && at <= 1);
    }
    const [, x, y, error, lit] = row(now);
    spot.setAttribute('cx', frame[0] * x + frame[2]);
    spot.setAttribute('cy', frame[1] * y + frame[3]);
    spot.setAttribute('class', lit ? 'on lit' : 'on');
    slider.value = now;
    readout.textContent = `${now.toFixed(view[1] - view[0] < 1 ? 4 : 2)} s · x ${x.toFixed(1)} mm · y ${y.toFixed(1)} mm · ` +
      (lit ? `error ${error.toFixed(2)} mm` : 'dark');
  };
  const reveal = () => { if (now < view[0] || now > view[1]) { const half = (view[1] - view[0]) / 2; look(now - half, now + half); } };
  const stop = () => { cancelAnimationFrame(playing); playing = 0; play.textContent = '▶'; play.setAttribute('aria-label', 'Play'); };
  const start = () => {
    if (now >= end) show(first);
    let last = performance.now();
    const step = at => {
      show(now + (at - last) / 1e3 * pace.value);
      last = at;
      if (now > view[1] && now < end) look(now, now + view[1] - view[0]);
      if (now >= end) stop(); else playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
    play.textContent = '❚❚';
    play.setAttribute('aria-label', 'Pause');
  };
  const toggle = () => playing ? stop() : start();

  for (const plot of plots) {
    const { area } = plot;
    let from = null;
    const pick = (a, b) => plots.forEach(p => {
      const [left, right] = [share(p, a), share(p, b)].map(s => Math.min(1, Math.max(0, s)));
      const style = p.area.querySelector('.pick').style;
      style.left = 100 * Math.min(left, right) + '%';
      style.width = 100 * Math.abs(right - left) + '%';
    });
    area.addEventListener('pointerdown', event => {
      if (event.button) return;
      from = event.clientX;
      area.setPointerCapture(event.pointerId);
    });
    area.addEventListener('pointermove', event => {
      if (!playing) show(timeAt(plot, event.clientX));
      if (from !== null) pick(timeAt(plot, from), timeAt(plot, event.clientX));
    });
    area.addEventListener('pointerup', event => {
      const began = from;
      from = null;
      pick(first, first);
      if (began === null) return;
      if (Math.abs(event.clientX - began) < 6) return show(timeAt(plot, event.clientX));
      const [a, b] = [timeAt(plot, began), timeAt(plot, event.clientX)];
      look(Math.min(a, b), Math.max(a, b));
    });
    area.addEventListener('pointercancel', () => { from = null; pick(first, first); });
    area.addEventListener('dblclick', () => look(first, end));
    area.addEventListener('keydown', event => {
      const length = view[1] - view[0], pixel = length / area.clientWidth * (event.shiftKey ? 10 : 1);
      const closer = factor => look(now - length * factor / 2, now + length * factor / 2);
      const keys = {
        ArrowLeft: () => { show(now - pixel); reveal(); }, ArrowRight: () => { show(now + pixel); reveal(); },
        Home: () => show(view[0]), End: () => show(view[1]),
        '+': () => closer(0.5), '=': () => closer(0.5), '-': () => closer(2), 0: () => look(first, end), Escape: () => look(first, end),
        ' ': toggle,
      };
      const act = keys[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act();
    });
    area.tabIndex = 0;
  }
  slider.min = first;
  slider.max = end;
  slider.addEventListener('input', () => { stop(); show(+slider.value); reveal(); });
  play.addEventListener('click', toggle);
  all.addEventListener('click', () => look(first, end));
  document.querySelectorAll('[data-with-script]').forEach(element => { element.hidden = false; });
  let width = innerWidth;
  addEventListener('resize', () => { if (innerWidth !== width) { width = innerWidth; plots.forEach(redraw); } });
  addEventListener('beforeprint', () => look(first, end));
  plots.forEach(redraw);
  slider.value = now;
  readout.textContent = `${first.toFixed(2)} s`;
})();

// The wall by day or by night, whatever the screen is.
(() => {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  for (const button of document.querySelectorAll('.wall-switch')) {
    const figure = button.closest('figure');
    let chosen = null;
    const show = () => {
      const night = chosen ?? dark.matches;
      button.setAttribute('aria-pressed', night);
      figure.classList.toggle('dark-wall', night);
      figure.classList.toggle('light-wall', !night);
    };
    button.addEventListener('click', () => { chosen = !(chosen ?? dark.matches); show(); });
    dark.addEventListener('change', show);
    button.hidden = false;
    show();
  }
})();
