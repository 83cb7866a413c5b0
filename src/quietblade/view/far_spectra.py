# SPDX-License-Identifier: LGPL-2.1-or-later
"""Multipoles and radiation efficiency over frequency."""

from matplotlib.figure import Figure

from quietblade.results.model import Result
from quietblade.results.quantities import LABELS
from quietblade.view.spectra import radiation_note
from quietblade.view.style import BLUE, CONFIGURATION, GREEN, GREY, VERMILION, new_figure, styled

_FREQUENCY = "Frequency [Hz]"
_TITLES = {"C0": "C0, at rest", "C1": "C1, under load"}
_FILLS = ((BLUE, "////"), (VERMILION, ""), (GREEN, "...."), (GREY, "xxxx"))


@styled
def draw_multipoles(result: Result) -> Figure:
    """Share of each multipole in the radiated power over frequency."""
    members = result.configurations
    figure = new_figure(2.1 * len(members) + 0.5)
    axes = figure.subplots(len(members), sharex=True, squeeze=False)[:, 0]
    for ax, (name, configuration) in zip(axes, members.items(), strict=True):
        far = configuration.far_field
        bands = ax.stackplot(far.frequency, 100.0 * far.share, labels=LABELS["multipole"])
        for band, (color, hatch) in zip(bands, _FILLS, strict=True):
            band.set(facecolor=color, alpha=0.75, hatch=hatch, edgecolor="white", linewidth=0.4)
        ax.set(
            title=f"{_TITLES[name]}; {radiation_note(configuration)}",
            xlim=(far.frequency[0], far.frequency[-1]), ylim=(0.0, 100.0),
            ylabel="Share of the\nradiated power [%]",
        )  # fmt: skip
    axes[-1].set_xlabel(_FREQUENCY)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


@styled
def draw_efficiency(result: Result) -> Figure:
    """Radiation efficiency over frequency."""
    figure = new_figure(3.2)
    ax = figure.subplots()
    for name, configuration in result.configurations.items():
        far = configuration.far_field
        ax.semilogy(far.frequency, far.efficiency, label=_TITLES[name],
                    **CONFIGURATION[name].options())  # fmt: skip
        pattern = configuration.directivity
        peaks = [i for i, reason in enumerate(pattern.reason) if reason == "peak"]
        ax.plot(pattern.frequency[peaks], pattern.efficiency[peaks], "o" if name == "C0" else "s",
                color=CONFIGURATION[name].color, markersize=3.5)  # fmt: skip
        ax.set_xlim(far.frequency[0], far.frequency[-1])
    notes = dict.fromkeys(radiation_note(c) for c in result.configurations.values())
    ax.set(xlabel=_FREQUENCY, ylabel="Radiation efficiency σ [–]")
    figure.suptitle(f"Radiation efficiency: {result.title}", x=0.01, ha="left", fontsize=9.0)
    figure.legend(
        *ax.get_legend_handles_labels(), loc="outside lower center", ncols=2,
        title="; ".join(notes) + "\nmarks: peaks of the radiated power", title_fontsize=7.5,
    )  # fmt: skip
    return figure
