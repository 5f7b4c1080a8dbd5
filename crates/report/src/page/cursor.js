// One cursor through all diagrams, and the spot on the map at that time. Nothing else depends on this.
(() => {
  const areas = [...document.querySelectorAll('.area')], spot = document.getElementById('spot');
  const readout = document.getElementById('readout');
  if (!track.length) return;
  const at = t => {
    let low = 0, high = track.length - 1;
    while (low < high) { const mid = (low + high + 1) >> 1; if (track[mid][0] <= t) low = mid; else high = mid - 1; }
    return track[low];
  };
  const show = t => {
    for (const area of areas) {
      const share = (t - area.dataset.from) / (area.dataset.to - area.dataset.from);
      area.lastElementChild.style.left = 100 * share + '%';
      area.classList.toggle('on', share >= 0 && share <= 1);
    }
    const [, x, y, error, lit] = at(t);
    spot.setAttribute('cx', frame[0] * x + frame[2]);
    spot.setAttribute('cy', frame[1] * y + frame[3]);
    spot.setAttribute('class', lit ? 'on lit' : 'on');
    readout.hidden = false;
    readout.textContent = `${t.toFixed(2)} s · x ${x.toFixed(1)} mm · y ${y.toFixed(1)} mm · ` +
      (lit ? `error ${error.toFixed(2)} mm` : 'dark');
  };
  const hide = () => {
    areas.forEach(area => area.classList.remove('on'));
    spot.setAttribute('class', '');
    readout.hidden = true;
  };
  for (const area of areas) {
    area.addEventListener('pointermove', event => {
      const box = area.getBoundingClientRect(), share = (event.clientX - box.left) / box.width;
      show(+area.dataset.from + share * (area.dataset.to - area.dataset.from));
    });
    area.addEventListener('pointerleave', hide);
  }
})();
