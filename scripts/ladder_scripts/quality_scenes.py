# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/score runs: kinds of scenes, each as the words that ladder_scene_run understands, and the grid of places."""
import itertools
from dataclasses import dataclass

DISTANCES_M = (0.6, 0.8, 1.0, 1.25, 1.5)
YAWS_DEG = (0.0, 15.0, -30.0)
# Parameters may be chosen while looking at the first; the second is for telling how good they are.
FIRST_SEED = {"tune": 1, "report": 70001}
TREADS = ("--rung_section", "tread")
SWAY = ("--sway_m", 0.03, "--sway_deg", 2, "--sway_hz", 0.5)


@dataclass(frozen=True)
class Kind:
    """`varying` has one entry per cell of the grid, in turn."""
    words: tuple
    is_ladder: bool = True
    frames: int | None = None  # where a scene needs another length than --frames
    varying: tuple = ((),)


def scene(name, *words, **others):
    return Kind(("--scene", name, *words), **others)


def sensor(width_px, height_px, horizontal_deg, vertical_deg):
    return ("--width_px", width_px, "--height_px", height_px, "--horizontal_deg", horizontal_deg, "--vertical_deg", vertical_deg)


KINDS = {
    "wall": scene("plain"),
    "missing": scene("missing"),
    "bent": scene("bent"),
    "broken": scene("broken"),
    "loose": scene("loose"),
    "clutter": scene("clutter"),
    "dark": scene("dark"),
    "no_wall": scene("no_wall"),
    "tilt_10": scene("tilt_10"),
    "incline_75": scene("incline_75"),
    "incline_60": scene("incline_60"),
    "round_19": scene("plain", "--rung_diameter_m", 0.019),
    "round_25": scene("plain", "--rung_diameter_m", 0.025),
    "round_28": scene("plain", "--rung_diameter_m", 0.028),
    "round_35": scene("plain", "--rung_diameter_m", 0.035),
    "round_100": scene("plain", "--rung_diameter_m", 0.100),
    "square": scene("square"),
    "narrow": scene("plain", "--clear_width_m", 0.30, "--spacing_m", 0.25),
    "wide": scene("plain", "--clear_width_m", 0.60, "--spacing_m", 0.356),
    "noise_2": scene("plain", "--noise_share", 0.02),
    "wrapped": scene("plain", "--wrap_range_m", 2.49),
    "head_dead": scene("plain", varying=tuple(("--dead_heads", i) for i in range(4))),
    "heads_dead": scene("plain", varying=tuple(("--dead_heads", f"{a},{b}") for a, b in itertools.combinations(range(4), 2))),
    "skew_sway": scene("plain", "--rate_hz", 10, "--stagger_hz", 40, *SWAY),
    "sway_blind": scene("plain", *SWAY, "--no_odometry"),
    "climbing": scene("plain", "--num_rungs", 12, "--climb_m_s", 0.1, *SWAY, frames=150),
    "removal": scene("plain", "--remove_rung_s", 1.2, "--removed_rung", 2, frames=60),
    "extrinsics": scene("plain", "--extrinsic_sigma_m", 0.010, "--extrinsic_sigma_deg", 1.0, frames=150),
    "treads_75": scene("incline_75", *TREADS),
    "treads_60": scene("incline_60", *TREADS),
    **{name: scene(name, is_ladder=False) for name in
       "stairs handrail shelf window_bars scaffold empty_room boxes posts free_bar cupboard".split()},
}
# Nobody may choose a parameter by these: other sensors, errors, shapes, sizes and neighbours, at places between those of the grid.
HELD_OUT = {
    "coarse": scene("plain", *sensor(100, 100, 70, 60), "--range_max_m", 2.5),
    "fine": scene("plain", *sensor(320, 240, 62, 48)),
    "wide_view": scene("plain", *sensor(224, 171, 90, 70)),
    "noise_half": scene("plain", "--noise_share", 0.005),
    "noise_1_5": scene("plain", "--noise_share", 0.015),
    "noise_5mm": scene("plain", "--noise_share", 0, "--noise_floor_m", 0.005),
    "blots_5mm": scene("plain", "--pixel_bias_m", 0.005),
    "edges_kept": scene("plain", "--edge_dropout", 0),
    "holes": scene("plain", "--random_dropout", 0.25),
    "oval": scene("plain", "--rung_section", "oval"),
    "flat_top": scene("plain", "--rung_section", "flat_top"),
    "round_rails": scene("plain", varying=tuple(("--rail_diameter_m", mm / 1000) for mm in (34, 42, 48))),
    "broad_rails": scene("plain", varying=tuple(("--rail_width_m", mm / 1000) for mm in (25, 40, 60))),
    "sizes": scene("plain", varying=tuple(
        ("--clear_width_m", width_m, "--spacing_m", spacing_m, "--rung_diameter_m", diameter_m)
        for width_m, spacing_m, diameter_m in ((0.35, 0.25, 0.022), (0.5, 0.28, 0.032), (0.45, 0.33, 0.04), (0.38, 0.35, 0.02)))),
    "dark_wall": scene("plain", "--wall_reflectance", 0.04),
    "white_wall": scene("plain", "--wall_reflectance", 0.95),
    **{name: scene(name) for name in "doorway fence two_ladders steps".split()},
    "field": scene("doorway", "--rail_diameter_m", 0.04, "--rung_section", "oval", "--rung_diameter_m", 0.024, "--clear_width_m", 0.43,
                   "--spacing_m", 0.28, "--noise_share", 0.013, "--pixel_bias_m", 0.003, "--random_dropout", 0.1, "--extrinsic_sigma_m", 0.003,
                   "--extrinsic_sigma_deg", 0.3),
    **{name: scene(name, is_ladder=False) for name in "narrow_shelf chair pipes towel_rail gate".split()},
}
ALL = {**KINDS, **HELD_OUT}
HELD_OUT_PLACES = tuple(itertools.product((0.7, 0.9, 1.15, 1.4), (-20.0, 8.0, 30.0)))


@dataclass(frozen=True)
class Run:
    kind: str
    words: tuple
    frames: int

    def command(self):
        return " ".join(map(str, (*self.words, "--frames", self.frames)))


def runs_of(kinds, first_seed, repeats, frames, places=None, every=1):
    """Every kind at every place of the grid; each place has its own seed."""
    grid = list(itertools.product(DISTANCES_M, YAWS_DEG))
    found = []
    for name in kinds:
        kind = ALL[name]
        for i, (_, (distance_m, yaw_deg)) in enumerate(itertools.product(range(repeats), places or (HELD_OUT_PLACES if name in HELD_OUT else grid))):
            if i % every:
                continue
            words = (*kind.words, *kind.varying[i % len(kind.varying)], f"--distance_m={distance_m}", f"--yaw_deg={yaw_deg}",
                     "--seed", first_seed + i)
            found.append(Run(name, words, kind.frames or frames))
    return found
