/* SPDX-License-Identifier: LGPL-2.1-or-later
   Moves the blade of a report: a steady deformation grows from none, a mode swings as
   Re(U exp(i phase)). Draws with plotly.js, which the page carries. */
"use strict";
(async () => {
  const STEPS = 32767; // of a displacement up to the largest, see interactive.py
  const MOST = 0.3, USUAL = 0.12; // size of a mode over the span
  const PERIOD = 1600; // of one swing on the screen, ms
  const CAMERA = { up: { x: 0, y: 1, z: 0 }, eye: { x: -1.1, y: 1.0, z: 0.6 },
    center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } }; // suction side and tip
  const element = (id) => document.getElementById(id);
  const box = element("view3d"), plot = element("view3d-plot");
  const controls = box.querySelector("form").elements;

  async function unpacked(id) {
    const text = atob(element(id).textContent);
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream);
  }

  function fail(error) {
    const told = element("view3d-failed");
    told.textContent = `The interactive view needs WebGL and a browser of 2023 or later (${error}).`;
    told.hidden = false;
    box.hidden = true;
    element("view3d-still").hidden = false;
    document.documentElement.dataset.view3d = "failed";
  }

  // --- what there is to show --------------------------------------------------------------

  function readScene(numbers) {
    const scene = JSON.parse(element("view3d-scene").textContent);
    const array = (kind, place) => place && new kind(numbers, place[0], place[1]);
    const shows = [];
    for (const surface of scene.surfaces) {
      const body = {
        configuration: surface.configuration,
        points: array(Float32Array, surface.points),
        blade: corners(array(Int32Array, surface.blade)),
        film: corners(array(Int32Array, surface.film)),
      };
      for (const motion of surface.motions) {
        shows.push({
          ...motion, body,
          key: motion.name ? `${surface.configuration}-${motion.name}` : "steady",
          real: array(Int16Array, motion.real),
          imag: array(Int16Array, motion.imag),
        });
      }
    }
    return { span: scene.span, scale: scene.scale, shows };
  }

  function corners(flat) {
    const part = (k) => flat.filter((_, n) => n % 3 === k);
    return { i: part(0), j: part(1), k: part(2) };
  }

  /* Coordinates of all nodes, each shifted by the part of its motion at a phase. */
  function moved(show, size, phase) {
    const c = Math.cos(phase), s = Math.sin(phase), { points } = show.body;
    const n = points.length / 3, axes = [0, 1, 2].map(() => new Float32Array(n));
    for (let node = 0; node < n; node++) {
      for (let a = 0; a < 3; a++) {
        const at = 3 * node + a;
        const part = show.real[at] * c - (show.imag ? show.imag[at] * s : 0);
        axes[a][node] = points[at] + (size / STEPS) * part;
      }
    }
    return axes;
  }

  function amplitude(show) {
    return Float32Array.from({ length: show.real.length / 3 }, (_, node) => {
      let sum = 0;
      for (let at = 3 * node; at < 3 * node + 3; at++) {
        sum += show.real[at] ** 2 + (show.imag ? show.imag[at] ** 2 : 0);
      }
      return Math.sqrt(sum) / STEPS * (show.name ? 1 : show.largest);
    });
  }

  // --- the state of the view ---------------------------------------------------------------

  let show, playing = false, started = 0, drawing = null;
  const steady = () => !show.name;
  // a steady deformation has a size of its own, a mode has none
  const size = () => Number(controls.size.value) * (steady() ? 2 * show.largest : MOST * span);

  function tell() {
    const mm = size();
    if (steady()) {
      const times = mm / show.largest || 0;
      const to = Math.abs(times - 1) < 0.005 ? "true to scale" : `drawn ${times.toFixed(2)} times`;
      element("view3d-told").textContent =
        `Deformation under the steady load, from C0 (at rest) to C1: largest displacement ` +
        `${show.largest.toPrecision(3)} mm, ${to}.`;
      return;
    }
    element("view3d-told").textContent =
      `${show.body.configuration}, mode ${show.name}: ${Math.abs(show.frequency).toFixed(2)} Hz, ` +
      `${show.loss === null ? "rigid" : `loss factor ${show.loss.toExponential(1)}`}. A mode has no size of its own: its largest displacement is ` +
      `drawn as ${mm.toFixed(0)} mm (${(100 * mm / span).toFixed(0)} % of the ${scale}), in slow motion.`;
  }

  /* Axes that hold every phase, with one scale. */
  function frame() {
    const phases = steady() ? [0, Math.PI / 2] : [0, Math.PI / 2, Math.PI, 1.5 * Math.PI];
    const all = phases.map((phase) => moved(show, size(), phase)).concat([atRest()]);
    const ranges = [0, 1, 2].map((a) => {
      let low = Infinity, high = -Infinity;
      for (const x of all.flatMap((axes) => [...axes[a]])) {
        low = Math.min(low, x);
        high = Math.max(high, x);
      }
      const margin = 0.02 * span;
      return [low - margin, high + margin];
    });
    const lengths = ranges.map(([low, high]) => high - low), longest = Math.max(...lengths);
    const update = {};
    ["x", "y", "z"].forEach((name, a) => {
      update[`scene.${name}axis.range`] = ranges[a];
      update[`scene.aspectratio.${name}`] = 1.75 * lengths[a] / longest;
    });
    return update;
  }
  const atRest = () => moved(show, 0, 0);

  function phaseNow(now) {
    const phase = 2 * Math.PI * ((now - started) / PERIOD % 1);
    return steady() ? Math.acos(0.5 - 0.5 * Math.cos(phase)) : phase; // grows from none to all
  }

  async function draw(phase) {
    const [x, y, z] = moved(show, size(), phase);
    await Plotly.restyle(plot, { x: [x, x], y: [y, y], z: [z, z] }, [1, 2]);
  }

  async function play(now) {
    if (!playing) return;
    await draw(phaseNow(now));
    requestAnimationFrame(play);
  }

  async function choose() {
    show = shows.find((candidate) => candidate.key === controls.motion.value);
    controls.size.value = steady() ? 0.5 : USUAL / MOST;
    controls.size.title = steady() ? "against the true displacement" : `against the ${scale}`;
    const rest = atRest(), now = moved(show, size(), 0), { blade, film } = show.body;
    const transparent = controls.film.checked && film.i.length > 0;
    const axes = ([x, y, z]) => ({ x, y, z });
    const common = { type: "mesh3d", hoverinfo: "skip", flatshading: false,
      lighting: { ambient: 0.75, diffuse: 0.4, specular: 0.05, roughness: 0.9 } };
    const traces = [
      { ...common, ...axes(rest), ...blade, color: "#8a949c", opacity: 0.18,
        visible: controls.rest.checked },
      { ...common, ...axes(now), ...blade, intensity: amplitude(show), colorscale: "Viridis",
        cmin: 0, cmax: steady() ? show.largest : 1, opacity: transparent ? 0.15 : 1,
        colorbar: { title: { text: steady() ? "Displacement [mm]"
          : "Amplitude over<br>the largest [–]" }, thickness: 14, len: 0.7 } },
      // without shades, as its faces are closer than the depth of a browser tells apart
      { ...common, ...axes(now), ...film, color: "#E69F00", visible: transparent,
        lighting: { ambient: 1, diffuse: 0, specular: 0 } },
    ];
    controls.film.disabled = film.i.length === 0;
    const axis = (title) => ({ title: { text: `${title} [mm]` }, backgroundcolor: "#f5f6f7",
      showbackground: true, gridcolor: "#d5d9dc" });
    const layout = {
      margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "kept", paper_bgcolor: "white",
      scene: {
        uirevision: "kept", dragmode: "orbit", aspectmode: "manual",
        xaxis: axis("x"), yaxis: axis("y"), zaxis: axis("z"),
        camera: CAMERA,
      },
    };
    await Plotly.react(plot, traces, layout, { displaylogo: false, responsive: true,
      plotlyServerURL: "", // nothing of a report goes to any server
      modeBarButtons: [["toImage", "zoom3d", "pan3d", "orbitRotation"]] });
    await Plotly.relayout(plot, frame());
    tell();
  }

  // --- controls ----------------------------------------------------------------------------

  function fill() {
    const titles = { C0: "Wet modes at rest (C0)", C1: "Wet modes under load (C1)" };
    const groups = {};
    for (const each of shows) {
      const option = new Option(each.name ? `${each.name}, ${Math.abs(each.frequency).toFixed(1)} Hz (${
        each.body.configuration})` : "Deformation under load (C1)", each.key);
      if (!each.name) { controls.motion.append(option); continue; }
      const name = each.body.configuration;
      groups[name] ??= controls.motion.appendChild(
        Object.assign(document.createElement("optgroup"), { label: titles[name] }));
      groups[name].append(option);
    }
    const wanted = decodeURIComponent(location.hash.slice(1));
    if (!shows.some((each) => each.key === wanted)) return;
    controls.motion.value = wanted;
    box.scrollIntoView();
  }

  function connect() {
    controls.motion.addEventListener("change", () => {
      history.replaceState(null, "", `#${controls.motion.value}`); // a link to this motion
      choose();
    });
    controls.film.addEventListener("change", choose);
    controls.rest.addEventListener("change", () =>
      Plotly.restyle(plot, { visible: controls.rest.checked }, [0]));
    controls.size.addEventListener("input", async () => {
      tell();
      if (!playing) await draw(0);
    });
    controls.size.addEventListener("change", () => Plotly.relayout(plot, frame()));
    controls.home.addEventListener("click", () => Plotly.relayout(plot, { "scene.camera": CAMERA }));
    controls.play.addEventListener("click", () => {
      playing = !playing;
      controls.play.textContent = playing ? "Pause" : "Play";
      if (playing) { started = performance.now(); requestAnimationFrame(play); } else draw(0);
    });
  }

  let span, scale, shows;
  try {
    if (!document.createElement("canvas").getContext("webgl")) throw new Error("no WebGL here");
    const library = document.createElement("script");
    library.textContent = await (await unpacked("view3d-library")).text();
    document.head.append(library);
    ({ span, scale, shows } = readScene(await (await unpacked("view3d-numbers")).arrayBuffer()));
    box.hidden = false; // plotly measures the place it gets
    fill();
    connect();
    await choose();
    element("view3d-still").hidden = true;
    document.documentElement.dataset.view3d = "ready";
  } catch (error) {
    fail(error.message || error);
  }
})();
