"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  function brush(canvas) {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio); pen.font = "12px system-ui, sans-serif"; pen.clearRect(0, 0, width, height);
    return [pen, width, height];
  }
  const COLOURS = ["#08306b", "#4a98c9", "#8c2d04", "#fd8d3c"];
  function draw_chart(canvas, chart, row) {
    const [pen, width, height] = brush(canvas), left = 62, top = 34, right = width - 8, bottom = height - 20;
    let low = Infinity, high = -Infinity;
    for (const line of chart.lines) for (const value of line.values) if (value !== null) { low = Math.min(low, value); high = Math.max(high, value); }
    if (low > high) { low = 0; high = 1; }
    if (low === high) { low -= 1; high += 1; }
    const last = data.time[data.time.length - 1] || 1;
    const x = (t) => left + (right - left) * t / last, y = (v) => bottom - (bottom - top) * (v - low) / (high - low);
    pen.fillStyle = "#222"; pen.fillText(chart.title, left, 12);
    pen.strokeStyle = "#ddd"; pen.textAlign = "right";
    for (const part of [0, .5, 1]) { const v = low + part * (high - low); pen.beginPath(); pen.moveTo(left, y(v)); pen.lineTo(right, y(v)); pen.stroke(); pen.fillText(String(+v.toPrecision(3)), left - 6, y(v) + 4); }
    pen.textAlign = "left"; pen.fillText("0", left, height - 5); pen.textAlign = "right"; pen.fillText(last.toFixed(1) + " s", right, height - 5); pen.textAlign = "left";
    const named = (line, name) => name + " " + (line.values[row] === null ? "none" : String(+line.values[row].toPrecision(4)));
    const wide = chart.lines.reduce((sum, line) => sum + pen.measureText(named(line, line.name)).width + 14, 0) > right - left + 14;
    let place = left;
    chart.lines.forEach((line, k) => {
      pen.strokeStyle = pen.fillStyle = COLOURS[k % COLOURS.length]; pen.lineWidth = 1.4; pen.beginPath();
      let begun = false;
      line.values.forEach((value, i) => { if (value === null) { begun = false; return; } if (begun) pen.lineTo(x(data.time[i]), y(value)); else pen.moveTo(x(data.time[i]), y(value)); begun = true; });
      pen.stroke();
      const words = named(line, wide ? line.name.replace(/^\D+(?=\d)/, "") + ":" : line.name);
      pen.fillText(words, place, 27); place += pen.measureText(words).width + 14;
    });
    pen.strokeStyle = "#222"; pen.lineWidth = 1; pen.beginPath(); pen.moveTo(x(data.time[row]), top); pen.lineTo(x(data.time[row]), bottom); pen.stroke();
  }
  function draw_wagon(row) {
    const [pen, width, height] = brush(element("wagon")), w = data.wagon, half = Math.max(w.length, w.pivot_spacing + w.wheelbase + 2 * w.radius) / 2 + .4;
    const scale = Math.min(width / (2 * half), (height - 70) / (w.bottom + w.height + .3)), ground = height - 52;
    const x = (m) => width / 2 + m * scale, y = (m) => ground - m * scale;
    pen.strokeStyle = "#555"; pen.lineWidth = 2; pen.beginPath(); pen.moveTo(0, ground); pen.lineTo(width, ground); pen.stroke();
    const fit = (m) => Math.min(Math.max(m, 0), w.height);
    pen.fillStyle = "#7fb3d9"; pen.beginPath();
    const rise = data.rise ? data.rise[row] : null;
    if (rise) {
      pen.moveTo(x(w.length / 2), y(w.bottom));
      rise.forEach((value, i) => pen.lineTo(x(w.length / 2 - data.place[i]), y(w.bottom + fit(w.depth + value))));
      pen.lineTo(x(-w.length / 2), y(w.bottom)); pen.fill();
    } else {
      const front = data.walls[0][row], rear = data.walls[1][row];
      pen.fillRect(x(w.length / 2) - 8, y(w.bottom + fit(w.depth + front)), 8, fit(w.depth + front) * scale);
      pen.fillRect(x(-w.length / 2), y(w.bottom + fit(w.depth + rear)), 8, fit(w.depth + rear) * scale);
    }
    pen.strokeStyle = "#222"; pen.strokeRect(x(-w.length / 2), y(w.bottom + w.height), w.length * scale, w.height * scale);
    pen.setLineDash([4, 4]); pen.lineWidth = 1;
    for (const from_rear of w.baffles) { pen.beginPath(); pen.moveTo(x(from_rear - w.length / 2), y(w.bottom)); pen.lineTo(x(from_rear - w.length / 2), y(w.bottom + w.height)); pen.stroke(); }
    pen.beginPath(); pen.moveTo(x(-w.length / 2), y(w.bottom + w.depth)); pen.lineTo(x(w.length / 2), y(w.bottom + w.depth)); pen.stroke(); pen.setLineDash([]);
    pen.fillStyle = "#222";
    for (const pivot of [w.pivot_spacing / 2, -w.pivot_spacing / 2]) {
      pen.lineWidth = 3; pen.beginPath(); pen.moveTo(x(pivot - w.wheelbase / 2), y(w.radius)); pen.lineTo(x(pivot + w.wheelbase / 2), y(w.radius)); pen.stroke();
    }
    data.wheels.forEach((wheel, i) => {
      const middle = (i < 2 ? 1 : -1) * w.pivot_spacing / 2 + (i % 2 ? -1 : 1) * w.wheelbase / 2, r = w.radius * scale;
      const stands = wheel.locked[row], angle = wheel.angle[row];
      pen.strokeStyle = stands ? "#c00000" : "#222"; pen.fillStyle = "#fff"; pen.lineWidth = stands ? 3 : 1.5;
      pen.beginPath(); pen.arc(x(middle), y(w.radius), r, 0, 2 * Math.PI); pen.fill(); pen.stroke();
      for (let k = 0; k < (stands ? 4 : 3); k++) { const a = angle + k * 2 * Math.PI / (stands ? 4 : 3); pen.beginPath(); pen.moveTo(x(middle), y(w.radius)); pen.lineTo(x(middle) + r * Math.cos(a), y(w.radius) + r * Math.sin(a)); pen.stroke(); }
      const part = Math.max(wheel.normal[row], 0) / wheel.static, long = Math.min(14 * part, 30);
      pen.strokeStyle = pen.fillStyle = COLOURS[i]; pen.lineWidth = 2;
      pen.beginPath(); pen.moveTo(x(middle), ground + 4 + long); pen.lineTo(x(middle), ground + 4); pen.lineTo(x(middle) - 3, ground + 8); pen.moveTo(x(middle), ground + 4); pen.lineTo(x(middle) + 3, ground + 8); pen.stroke();
      pen.textAlign = "center"; pen.fillText((wheel.normal[row] / 1e3).toFixed(0) + (width > 600 ? " kN" : ""), x(middle), height - 4 - (width > 600 ? 0 : 12 * (i % 2)));
    });
    pen.textAlign = "left"; pen.fillStyle = "#222"; pen.fillText("travel \u2192", width - 60, 14);
  }
  function replay() {
    const scrub = element("scrub"), play = element("play"), now = element("now"), last = data.time.length - 1;
    const boxes = data.charts.map((chart) => { const canvas = document.createElement("canvas"); canvas.setAttribute("role", "img"); canvas.setAttribute("aria-label", chart.title); element("charts").append(canvas); return canvas; });
    let row = 0, timer = 0, began = 0, from = 0;
    function show() {
      scrub.value = row;
      now.textContent = data.time[row].toFixed(2) + " s, " + (3.6 * data.speed[row]).toFixed(1) + " km/h, " + data.position[row].toFixed(1) + " m";
      draw_wagon(row); boxes.forEach((canvas, k) => draw_chart(canvas, data.charts[k], row));
    }
    function pause() { cancelAnimationFrame(timer); timer = 0; play.textContent = "Play"; }
    function tick(moment) {
      const clock = from + (moment - began) / 1000;
      while (row < last && data.time[row + 1] <= clock) row++;
      show();
      if (row < last) timer = requestAnimationFrame(tick); else pause();
    }
    function start() { if (row === last) row = 0; from = data.time[row]; play.textContent = "Pause"; timer = requestAnimationFrame((moment) => { began = moment; tick(moment); }); }
    const toggle = () => { if (timer) pause(); else start(); }, go = (to) => { pause(); row = Math.min(Math.max(to, 0), last); show(); };
    play.addEventListener("click", toggle);
    scrub.addEventListener("input", () => go(Number(scrub.value)));
    document.addEventListener("keydown", (event) => {
      if (event.target.tagName === "BUTTON" && event.key === " ") return;
      const step = event.shiftKey ? 20 : 1;
      if (event.key === " ") toggle(); else if (event.key === "ArrowRight") go(row + step); else if (event.key === "ArrowLeft") go(row - step); else return;
      event.preventDefault();
    });
    window.addEventListener("resize", show); window.addEventListener("beforeprint", show);
    show();
  }
  function sortable(table) {
    const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
    const order = (a, b) => { if (a === "" || b === "") return (a === "") - (b === ""); const n = Number(a), m = Number(b); return Number.isNaN(n) || Number.isNaN(m) ? a.localeCompare(b) : n - m; };
    heads.forEach((head, k) => head.firstChild.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort")); head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const text = (row) => row.cells[k].textContent;
      const rows = [...body.rows].sort((a, b) => text(a) === "" || text(b) === "" ? order(text(a), text(b)) : (down ? -1 : 1) * order(text(a), text(b)));
      body.append(...rows);
    }));
    const quoted = (cell) => "\"" + (cell.title || cell.textContent).replace(/"/g, "\"\"") + "\"";
    table.closest("section").querySelector(".download").addEventListener("click", () => {
      const text = [...table.rows].map((row) => [...row.cells].map(quoted).join(",")).join("\r\n");
      const link = document.createElement("a"); link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" })); link.download = table.closest("section").querySelector("h2").textContent.toLowerCase().replace(/\W+/g, "-") + ".csv"; link.click();
    });
  }
  if (data.time) replay();
  document.querySelectorAll("table.sortable").forEach(sortable);
})();
