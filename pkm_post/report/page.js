"use strict";
// The path in 3D, turned by mouse, and one instant shown in all views. No library, no network.
(function () {
  const data = JSON.parse(document.getElementById("path-data").textContent);
  const floats = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const tip = floats(data.tip), time = floats(data.time), axes = floats(data.axes);
  const canvas = document.getElementById("path"), context = canvas.getContext("2d");
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name);
  const view = { turn: -0.9, tilt: 0.45, zoom: 1, x: 0, y: 0 };
  let chosen = -1;

  const centre = [0, 1, 2].map((k) => (data.low[k] + data.high[k]) / 2);
  const size = Math.hypot(...[0, 1, 2].map((k) => data.high[k] - data.low[k])) || 1;

  function project(points, row) {
    const x = points[3 * row] - centre[0], y = points[3 * row + 1] - centre[1], z = points[3 * row + 2] - centre[2];
    const c = Math.cos(view.turn), s = Math.sin(view.turn), depth = s * x + c * y;
    const scale = view.zoom * 0.9 * Math.min(canvas.width, canvas.height) / size;
    return [canvas.width / 2 + view.x + scale * (c * x - s * y),
            canvas.height / 2 + view.y - scale * (Math.cos(view.tilt) * z + Math.sin(view.tilt) * depth)];
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    context.lineWidth = ratio * 0.5;
    context.strokeStyle = colour("--rule");
    context.beginPath();
    for (let row = 0; 3 * row < axes.length; row += 2) {
      context.moveTo(...project(axes, row));
      context.lineTo(...project(axes, row + 1));
    }
    context.stroke();
    for (const run of data.runs) {
      context.strokeStyle = colour(run.rapid ? "--soft" : `--c${1 + run.operation % 6}`);
      context.setLineDash(run.rapid ? [2 * ratio, 4 * ratio] : []);
      context.lineWidth = ratio * (run.rapid ? 0.7 : 1);
      context.beginPath();
      context.moveTo(...project(tip, run.first));
      for (let row = run.first + 1; row <= run.last; row++) context.lineTo(...project(tip, row));
      context.stroke();
    }
    context.setLineDash([]);
    if (chosen >= 0) {
      context.fillStyle = colour("--bad");
      context.beginPath();
      context.arc(...project(tip, chosen), 5 * ratio, 0, 2 * Math.PI);
      context.fill();
    }
  }

  function choose(instant) {
    let low = 0, high = time.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle] <= instant) low = middle; else high = middle;
    }
    chosen = instant - time[low] < time[high] - instant ? low : high;
    for (const chart of document.querySelectorAll("svg.chart")) {
      let marker = chart.querySelector(".marker");
      if (!marker) {
        marker = document.createElementNS("http://www.w3.org/2000/svg", "path");
        marker.setAttribute("class", "marker");
        chart.append(marker);
      }
      const left = Number(chart.dataset.left), width = chart.dataset.right - left;
      const x = left + width * instant / chart.dataset.duration;
      marker.setAttribute("d", `M${x} 14V210`);
    }
    draw();
  }

  let held = null;
  canvas.addEventListener("pointerdown", (event) => { held = event; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointerup", () => { held = null; });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    const dx = event.clientX - held.clientX, dy = event.clientY - held.clientY, ratio = window.devicePixelRatio || 1;
    if (held.shiftKey || held.button === 2) { view.x += dx * ratio; view.y += dy * ratio; }
    else { view.turn -= dx / 150; view.tilt = Math.max(0, Math.min(Math.PI / 2, view.tilt + dy / 150)); }
    held = { clientX: event.clientX, clientY: event.clientY, shiftKey: held.shiftKey, button: held.button };
    draw();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    view.zoom *= Math.exp(-event.deltaY / 500);
    event.preventDefault();
    draw();
  }, { passive: false });
  canvas.addEventListener("dblclick", () => { Object.assign(view, { turn: -0.9, tilt: 0.45, zoom: 1, x: 0, y: 0 }); draw(); });
  for (const chart of document.querySelectorAll("svg.chart")) {
    chart.addEventListener("click", (event) => {
      const box = chart.getBoundingClientRect(), x = 1000 * (event.clientX - box.left) / box.width;
      const left = Number(chart.dataset.left), share = (x - left) / (chart.dataset.right - left);
      choose(Math.max(0, Math.min(1, share)) * chart.dataset.duration);
    });
  }
  for (const row of document.querySelectorAll("tr[data-time]")) {
    row.addEventListener("click", () => {
      for (const other of document.querySelectorAll("tr.chosen")) other.classList.remove("chosen");
      row.classList.add("chosen");
      choose(Number(row.dataset.time));
    });
  }
  window.addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  draw();
})();
