"use strict";
(() => {
  const train = JSON.parse(document.getElementById("data").textContent).train;
  if (!train) return;
  const element = (id) => document.getElementById(id), last = train.time.length - 1, count = train.forces.length;
  const end = train.time[last] || 1, most = Math.max(1e-9, ...train.compression, ...train.tension.map((v) => -v));
  const COLOURS = ["#08306b", "#8c2d04", "#4a98c9"], left = 62, gap = 12;
  let row = 0, timer = 0, began = 0, from = 0;
  function brush(id) {
    const canvas = element(id), ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio); pen.font = "12px system-ui, sans-serif"; pen.clearRect(0, 0, width, height);
    return [pen, width, height];
  }
  const number = (v) => String(+v.toPrecision(3));
  const x_of = (width) => (t) => left + (width - gap - left) * t / end;
  function time_axis(pen, width, height, top, bottom) {
    const x = x_of(width);
    pen.fillStyle = "#222"; pen.textAlign = "left"; pen.fillText("0", left, height - 5);
    pen.textAlign = "right"; pen.fillText(end.toFixed(1) + " s", width - gap, height - 5); pen.textAlign = "left";
    pen.strokeStyle = "#222"; pen.lineWidth = 1; pen.beginPath(); pen.moveTo(x(train.time[row]), top); pen.lineTo(x(train.time[row]), bottom); pen.stroke();
  }
  function colour(force) {
    const part = Math.min(1, Math.sqrt(Math.abs(force) / most)), pale = (full) => Math.round(247 + (full - 247) * part);
    return force > 0 ? `rgb(${pale(140)},${pale(20)},${pale(10)})` : `rgb(${pale(8)},${pale(48)},${pale(140)})`;
  }
  function waterfall() {
    const [pen, width, height] = brush("waterfall"), top = 36, bottom = height - 20, x = x_of(width), tall = (bottom - top) / train.vehicles;
    pen.fillStyle = "#222"; pen.fillText("Coupling force: red compression, blue tension, darkest " + number(most) + " kN", left, 12, width - left - gap);
    pen.fillText("Vehicle 1 above. Full line: brakes set in; dashed: 95 % applied", left, 28, width - left - gap);
    train.forces.forEach((force, k) => force.forEach((value, i) => {
      const next = i < last ? train.time[i + 1] : end;
      pen.fillStyle = colour(value); pen.fillRect(x(train.time[i]), top + (k + .5) * tall, Math.max(x(next) - x(train.time[i]), .5) + .5, tall + .5);
    }));
    for (const [times, dash] of [[train.onset, []], [train.applied, [5, 4]]]) {
      pen.strokeStyle = "#222"; pen.lineWidth = 1.4; pen.setLineDash(dash); pen.beginPath();
      let begun = false;
      times.forEach((t, k) => { if (t === null) { begun = false; return; } if (begun) pen.lineTo(x(t), top + (k + .5) * tall); else pen.moveTo(x(t), top + (k + .5) * tall); begun = true; });
      pen.stroke(); pen.setLineDash([]);
    }
    pen.fillStyle = "#222"; pen.textAlign = "right";
    const step = Math.max(1, Math.ceil(train.vehicles / Math.floor((bottom - top) / 14)));
    for (let k = 1; k <= train.vehicles; k += step) pen.fillText(String(k), left - 6, top + (k - .5) * tall + 4);
    time_axis(pen, width, height, top, bottom);
  }
  function along() {
    const [pen, width, height] = brush("along"), top = 36, bottom = height - 20;
    const high = Math.max(...train.compression, 0), low = Math.min(...train.tension, 0), span = (high - low) || 1;
    const x = (k) => left + (width - gap - left) * (count > 1 ? k / (count - 1) : .5), y = (v) => bottom - (bottom - top) * (v - low) / span;
    pen.fillStyle = "#222"; pen.fillText("Coupling forces along the train, kN, compression above", left, 12, width - left - gap);
    pen.fillText("Thin: largest of the stop; thick: at the cursor", left, 28, width - left - gap);
    pen.textAlign = "right";
    for (const v of new Set([high, 0, low])) { pen.strokeStyle = "#ddd"; pen.lineWidth = 1; pen.beginPath(); pen.moveTo(left, y(v)); pen.lineTo(width - gap, y(v)); pen.stroke(); pen.fillText(number(v), left - 6, y(v) + 4); }
    const line = (values, stroke, wide) => { pen.strokeStyle = pen.fillStyle = stroke; pen.lineWidth = wide; pen.beginPath(); values.forEach((v, k) => k ? pen.lineTo(x(k), y(v)) : pen.moveTo(x(k), y(v))); pen.stroke(); if (count < 2) values.forEach((v, k) => pen.fillRect(x(k) - 3, y(v) - wide, 6, 2 * wide)); };
    line(train.compression, COLOURS[1], 1.2); line(train.tension, COLOURS[0], 1.2); line(train.forces.map((force) => force[row]), "#222", 2.6);
    pen.fillStyle = "#222"; pen.textAlign = "left"; pen.fillText("coupling 1", left, height - 5); pen.textAlign = "right"; if (count > 1) pen.fillText("coupling " + count, width - gap, height - 5); pen.textAlign = "left";
  }
  function speeds() {
    const [pen, width, height] = brush("speeds"), top = 36, bottom = height - 20, x = x_of(width), values = train.speeds.flatMap((one) => one.values);
    const high = Math.max(...values), low = Math.min(0, ...values), y = (v) => bottom - (bottom - top) * (v - low) / ((high - low) || 1);
    pen.fillStyle = "#222"; pen.fillText("Speed, km/h", left, 12); pen.textAlign = "right";
    for (const v of new Set([high, 0])) { pen.strokeStyle = "#ddd"; pen.beginPath(); pen.moveTo(left, y(v)); pen.lineTo(width - gap, y(v)); pen.stroke(); pen.fillText(number(v), left - 6, y(v) + 4); }
    pen.textAlign = "left";
    let place = left;
    train.speeds.forEach((one, k) => {
      pen.strokeStyle = pen.fillStyle = COLOURS[k]; pen.lineWidth = 1.4; pen.beginPath();
      one.values.forEach((v, i) => i ? pen.lineTo(x(train.time[i]), y(v)) : pen.moveTo(x(train.time[i]), y(v))); pen.stroke();
      const words = one.name + " " + one.values[row].toFixed(1); pen.fillText(words, place, 28); place += pen.measureText(words).width + 14;
    });
    time_axis(pen, width, height, top, bottom);
  }
  function show() {
    element("scrub").value = row;
    let words = train.time[row].toFixed(2) + " s, " + train.speeds[0].values[row].toFixed(1) + " km/h";
    if (count) { const now = train.forces.map((force) => force[row]), k = now.reduce((best, v, i) => Math.abs(v) > Math.abs(now[best]) ? i : best, 0); words += ", " + (now[k] < 0 ? "tension " : "compression ") + Math.abs(now[k]).toFixed(1) + " kN in coupling " + (k + 1); }
    element("now").textContent = words;
    if (count) { waterfall(); along(); }
    speeds();
  }
  function go(to) { row = Math.min(Math.max(to, 0), last); show(); }
  function pause() { cancelAnimationFrame(timer); timer = 0; element("play").textContent = "Play"; }
  function frame(now) {
    const t = from + (now - began) / 1000;
    let next = row; while (next < last && train.time[next] < t) next++;
    go(next); if (row < last) timer = requestAnimationFrame(frame); else pause();
  }
  function play() { if (timer) return pause(); if (row >= last) row = 0; from = train.time[row]; began = performance.now(); element("play").textContent = "Pause"; timer = requestAnimationFrame(frame); }
  element("play").addEventListener("click", play);
  element("scrub").addEventListener("input", (event) => { pause(); go(Number(event.target.value)); });
  for (const id of count ? ["waterfall", "speeds"] : ["speeds"]) element(id).addEventListener("click", (event) => { const t = end * (event.offsetX - left) / (element(id).clientWidth - gap - left); pause(); go(train.time.findIndex((one) => one >= t) < 0 ? last : train.time.findIndex((one) => one >= t)); });
  document.addEventListener("keydown", (event) => {
    if (event.target.tagName === "BUTTON" && event.key === " ") return;
    const step = event.shiftKey ? 20 : 1;
    if (event.key === " ") play(); else if (event.key === "ArrowRight") { pause(); go(row + step); } else if (event.key === "ArrowLeft") { pause(); go(row - step); } else return;
    event.preventDefault();
  });
  window.addEventListener("resize", show); window.addEventListener("beforeprint", show);
  show();
})();
