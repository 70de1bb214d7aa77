"""The report's plots as SVG text."""
import copy
import io

import matplotlib
import numpy as np

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402, the backend is chosen first

from object_modelling.report.object_data import AMBER_M, AMBER_PX, GREEN_M, GREEN_PX  # noqa: E402

COLOURS = {"green": "#2e9e4f", "amber": "#e6a117", "red": "#cc3333", "grey": "#999999"}
INK, BAR = "#333333", "#3c78b0"


def _svg(figure, salt):
    """Text of the picture without XML head; the same every time."""
    text = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": salt, "svg.fonttype": "none", "font.family": "sans-serif"}):
        figure.savefig(text, format="svg", bbox_inches="tight", transparent=True,
                       metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    pyplot.close(figure)
    svg = text.getvalue()
    return svg[svg.index("<svg"):]


def camera_path(keyframes, size_m):
    """From above and from the side, the object's box in the middle."""
    figure, (top, side) = pyplot.subplots(1, 2, figsize=(10, 4.6))
    seen = [keyframe for keyframe in keyframes if keyframe.position_m is not None]
    for axes, (u, v), title in ((top, (0, 1), "from above"), (side, (0, 2), "from the side")):
        half_u, half_v = size_m[u] / 2, size_m[v] / 2
        axes.add_patch(pyplot.Rectangle((-half_u, -half_v), 2 * half_u, 2 * half_v, facecolor="#dddddd", edgecolor=INK))
        for session in sorted({keyframe.session_id for keyframe in seen}):
            path = np.array([k.position_m for k in seen if k.session_id == session])
            axes.plot(path[:, u], path[:, v], color="#bbbbbb", linewidth=1, zorder=1)
        for keyframe in seen:
            axes.plot(keyframe.position_m[u], keyframe.position_m[v], "o", color=COLOURS[keyframe.light],
                      markersize=5, zorder=2)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("%s (m)" % "xyz"[u])
        axes.set_ylabel("%s (m)" % "xyz"[v])
        axes.set_title(title)
        axes.grid(color="#eeeeee")
    return _svg(figure, "path")


def residuals(keyframes):
    """Bars per keyframe, before and after, over the limits; None where nothing was refined."""
    measured = [keyframe for keyframe in keyframes if keyframe.residual is not None]
    if not measured:
        return None
    figure, panels = pyplot.subplots(2, 1, figsize=(10, 4.6), sharex=True)
    at = np.arange(len(measured))
    for axes, name, factor, unit, green, amber in (
            (panels[0], "reprojection_rmse_%s_px", 1, "px", GREEN_PX, AMBER_PX),
            (panels[1], "depth_rmse_%s_m", 1000, "mm", 1000 * GREEN_M, 1000 * AMBER_M)):
        before = [factor * keyframe.residual[name % "before"] for keyframe in measured]
        after = [factor * keyframe.residual[name % "after"] for keyframe in measured]
        axes.bar(at, after, 0.8, color=[COLOURS[keyframe.light] for keyframe in measured])
        axes.plot(at, before, "_", color=INK, markersize=6, label="before")
        for limit, colour in ((green, "green"), (amber, "amber")):
            if limit < 2 * max(before + after + [green]):
                axes.axhline(limit, color=COLOURS[colour], linewidth=1, linestyle="--")
        axes.set_ylabel("RMSE (%s)" % unit)
        axes.set_ylim(bottom=0)
    panels[0].legend(frameon=False, loc="upper right")
    panels[1].set_xlabel("keyframe")
    step = max(1, len(measured) // 30)
    panels[1].set_xticks(at[::step])
    panels[1].set_xticklabels([str(keyframe.keyframe_id) for keyframe in measured[::step]], fontsize=7)
    return _svg(figure, "residuals")


def sigma_histogram(sigma):
    """Share of the fused points by the standard deviation of their place."""
    width_mm = 1000 * sigma["histogram_bin_width_m"]
    counts = np.array(sigma["histogram_counts"], float)
    figure, axes = pyplot.subplots(figsize=(6.5, 3.4))
    axes.bar((np.arange(len(counts)) + 0.5) * width_mm, 100 * counts / max(1, counts.sum()), width_mm, color=BAR)
    for name, style in (("median_m", "-"), ("p95_m", "--")):
        axes.axvline(1000 * sigma[name], color=INK, linestyle=style, linewidth=1,
                     label="%s %.3f mm" % ({"median_m": "median", "p95_m": "95 % below"}[name], 1000 * sigma[name]))
    axes.set_xlabel("sigma along the normal (mm); the last bar holds all beyond")
    axes.set_ylabel("share of points (%)")
    axes.legend(frameon=False)
    return _svg(figure, "sigma")


def coverage_map(coverage):
    """Keyframes by direction from the object's centre."""
    counts = np.ma.masked_equal(np.array(coverage["view_counts"]), 0)
    colours = copy.copy(pyplot.get_cmap("viridis"))
    colours.set_bad("#f0d0d0")
    figure, axes = pyplot.subplots(figsize=(8, 3.6))
    image = axes.pcolormesh(np.linspace(0, 360, counts.shape[1] + 1), np.linspace(-90, 90, counts.shape[0] + 1), counts,
                            cmap=colours, vmin=1)
    figure.colorbar(image, ax=axes, label="keyframes within 30 deg")
    axes.set_xticks(range(0, 361, 45))
    axes.set_yticks(range(-90, 91, 30))
    axes.set_xlabel("azimuth about z, from x (deg); pale red: nobody looked from there")
    axes.set_ylabel("elevation (deg)")
    return _svg(figure, "coverage")


def stage_times(stage_s):
    """Seconds by stage."""
    names = sorted(stage_s, key=stage_s.get)
    figure, axes = pyplot.subplots(figsize=(6.5, 0.5 + 0.32 * len(names)))
    bars = axes.barh(names, [stage_s[name] for name in names], color=BAR)
    for bar, name in zip(bars, names):
        axes.text(bar.get_width(), bar.get_y() + bar.get_height() / 2, " %.2f s" % stage_s[name], va="center")
    axes.set_xlabel("seconds")
    axes.margins(x=0.15)
    return _svg(figure, "times")
