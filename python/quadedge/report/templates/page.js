// Shows which tables go on to the right. Unpacks plotly and draws plots when they become visible, and all of them
// before printing.
"use strict";
for (const table of document.querySelectorAll(".scroll")) {
  const mark = () => table.classList.toggle("more", table.scrollLeft + table.clientWidth < table.scrollWidth - 4);
  table.addEventListener("scroll", mark, {passive: true});
  new ResizeObserver(mark).observe(table);
}
(async () => {
  const places = [...document.querySelectorAll(".plot")];
  const unpacked = (id) => {
    const bytes = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  };
  if (places.length === 0) return;
  let code, figures;
  try {
    code = await unpacked("code-of-plotly");
    figures = JSON.parse(await unpacked("data-of-figures"));
  } catch (problem) {
    for (const place of places) place.textContent = "This browser is too old to draw the plots.";
    return;
  }
  const script = document.createElement("script");
  script.textContent = code;
  document.head.append(script);

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const common = () => ({
    autosize: true, margin: {l: 10, r: 10, t: 56, b: 10}, hovermode: "closest",
    font: {family: "system-ui, sans-serif", size: 12, color: colour("--ink")},
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    legend: {orientation: "h", y: -0.28, yanchor: "top", font: {size: 11}}, showlegend: true,
    modebar: {bgcolor: "rgba(0,0,0,0)", color: colour("--line"), activecolor: colour("--soft")},
  });
  // Looks from behind, the left and above, from so far that the box of a plot in space fits its place.
  const cameraOf = ({x, y, z}, place) => {
    const unit = (v) => v.map((c) => c / Math.hypot(...v));
    const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const eye = unit([-0.5, -0.75, 0.45]), right = unit(cross([0, 0, 1], eye)), up = cross(eye, right);
    const high = 0.92 * Math.tan(Math.PI / 8), wide = high * place.clientWidth / place.clientHeight;
    const corners = [...Array(8).keys()].map(
      (corner) => [x, y, z].map((length, axis) => (corner >> axis & 1 ? 0.5 : -0.5) * length));
    let centre = [0, 0, 0], distance = 0;
    for (let step = 0; step < 5; ++step) {  // nearer corners look larger: the view's middle is not the box's
      const seen = corners.map((corner) => corner.map((value, axis) => value - centre[axis]));
      distance = Math.max(...seen.map(
        (at) => dot(at, eye) + Math.max(Math.abs(dot(at, right)) / wide, Math.abs(dot(at, up)) / high)));
      const middle = (axis) => {
        const places = seen.map((at) => dot(at, axis) / (distance - dot(at, eye)));
        return 0.5 * (Math.min(...places) + Math.max(...places)) * distance;
      };
      const across = middle(right), upwards = middle(up);
      centre = centre.map((value, axis) => value + across * right[axis] + upwards * up[axis]);
    }
    const named = (v) => ({x: v[0], y: v[1], z: v[2]});
    return {eye: named(centre.map((value, axis) => value + distance * eye[axis])), center: named(centre)};
  };
  const layoutOf = (figure, place) => {
    const layout = {...common(), ...structuredClone(figure.layout)};
    layout.title = {...layout.title, font: {size: 14}, x: 0, xanchor: "left", xref: "paper", y: 0.99, yanchor: "top"};
    const axis = {gridcolor: colour("--line"), zerolinecolor: colour("--soft"), linecolor: colour("--soft")};
    if (!layout.scene) {
      const isTime = !layout.yaxis.scaleanchor;  // else a position, whose 0 is the first camera
      layout.xaxis = {...axis, zeroline: !isTime, ...layout.xaxis, title: {...layout.xaxis.title, standoff: 8}};
      layout.yaxis = {...axis, ...layout.yaxis, title: {...layout.yaxis.title, standoff: 8}};
      if (layout.xaxis.type === "category") {  // long names take the place of the legend
        layout.legend = {...layout.legend, y: 1.02, yanchor: "bottom"};
        layout.margin.t = 76;
      }
      return layout;
    }
    for (const name of ["xaxis", "yaxis", "zaxis"]) {
      layout.scene[name] = {...layout.scene[name], ...axis, backgroundcolor: "rgba(0,0,0,0)", color: colour("--ink")};
    }
    layout.scene.camera = cameraOf(layout.scene.aspectratio, place);
    layout.legend = {...layout.legend, y: 0, itemsizing: "constant"};
    return layout;
  };
  const draw = (place) => {
    const figure = figures[place.dataset.figure];
    place.dataset.drawn = "yes";
    Plotly.newPlot(place, structuredClone(figure.data), layoutOf(figure, place), {
      displaylogo: false, responsive: true, displayModeBar: matchMedia("(max-width: 699px)").matches ? false : "hover",
      toImageButtonOptions: {format: "svg", filename: place.id},
    });
  };
  const isSpatial = (place) => place.classList.contains("spatial");
  // Browsers limit the number of WebGL contexts: plots out of sight release theirs.
  const observer = new IntersectionObserver((entries) => {
    for (const {target, isIntersecting} of entries) {
      if (isIntersecting && !target.dataset.drawn) draw(target);
      if (!isIntersecting && target.dataset.drawn && isSpatial(target)) {
        Plotly.purge(target);
        delete target.dataset.drawn;
      }
    }
  }, {rootMargin: "300px"});
  for (const place of places) observer.observe(place);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    for (const place of places) if (place.dataset.drawn) draw(place);
  });

  // Two plots side by side on A4 or Letter in landscape, see @page; the browser lays out pages after this event.
  const paperWidth = 465, paperHeight = 265;
  let closed = [];
  addEventListener("beforeprint", () => {
    closed = [...document.querySelectorAll("details:not([open])")];
    for (const fold of closed) fold.open = true;
    for (const place of places) {
      if (isSpatial(place)) continue;
      if (!place.dataset.drawn) draw(place);
      Plotly.relayout(place, {autosize: false, width: paperWidth, height: paperHeight});
    }
  });
  addEventListener("afterprint", () => {
    for (const fold of closed) fold.open = false;
    for (const place of places) {
      if (!isSpatial(place)) Plotly.relayout(place, {autosize: true, width: null, height: null});
    }
  });
})();
