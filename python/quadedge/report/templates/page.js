// Unpacks plotly and draws plots when they become visible, and all of them before printing.
"use strict";
(async () => {
  const places = [...document.querySelectorAll(".plot")];
  const unpacked = (id) => {
    const bytes = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  };
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
  });
  const layoutOf = (figure) => {
    const layout = {...common(), ...structuredClone(figure.layout)};
    layout.title = {...layout.title, font: {size: 14}, x: 0, xanchor: "left", xref: "paper", y: 0.99, yanchor: "top"};
    const axis = {gridcolor: colour("--line"), zerolinecolor: colour("--soft"), linecolor: colour("--soft")};
    if (!layout.scene) {
      layout.xaxis = {...axis, ...layout.xaxis, title: {...layout.xaxis.title, standoff: 8}};
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
    layout.legend = {...layout.legend, y: 0};
    return layout;
  };
  const draw = (place) => {
    const figure = figures[place.dataset.figure];
    place.dataset.drawn = "yes";
    Plotly.newPlot(place, structuredClone(figure.data), layoutOf(figure), {
      displaylogo: false, responsive: true,
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
