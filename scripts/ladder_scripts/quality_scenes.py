# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/score runs: kinds of scenes, each as the words that ladder_scene_run understands, and the grid of places."""
import itertools
from dataclasses import dataclass

DISTANCES_M = (0.6, 0.8, 1.0, 1.25, 1.5)
YAWS_DEG = (0.0, 15.0, -30.0)
# Parameters may be chosen while looking at the first; the second is for telling how good they are.
FIRST_SEED = {"tune": 1, "report": 70001}
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
    **{name: scene(name, is_ladder=False) for name in
       "stairs handrail shelf window_bars scaffold empty_room boxes posts free_bar cupboard".split()},
}


@dataclass(frozen=True)
class Run:
    kind: str
    words: tuple
    frames: int

    def command(self):
        return " ".join(map(str, self.words))


def runs_of(kinds, first_seed, repeats, frames, places=None, every=1):
    """Every kind at every place of the grid; each place has its own seed."""
    places = places or list(itertools.product(DISTANCES_M, YAWS_DEG))
    found = []
    for name in kinds:
        kind = KINDS[name]
        for i, (_, (distance_m, yaw_deg)) in enumerate(itertools.product(range(repeats), places)):
            if i % every:
                continue
            words = (*kind.words, *kind.varying[i % len(kind.varying)], f"--distance_m={distance_m}", f"--yaw_deg={yaw_deg}",
                     "--seed", first_seed + i)
            found.append(Run(name, words, kind.frames or frames))
    return found
