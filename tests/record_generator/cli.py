"""The command: hammer records of a free-free sandwich beam, with their truth beside them.

examples, from the folder that holds record_generator:
  python -m record_generator out/one                          piece 1 of the seed, one place, five hits, 0.3 % noise
  python -m record_generator out/five --five-places --seed 2  a roving hammer at five places
  python -m record_generator out/bad --double-hit 2 --overload 4
  python -m record_generator out/g --format uff-binary --unit g --sensor-sign -1

The folder gets test.toml (what a user would write), the records, and truth.json (for a scorer alone). The same seed
gives the same records. SI units; x from the centre of the piece.
"""

import argparse
import sys

from . import beam, files, hammer, records


def main(arguments=None):
    """Read the command line and write the folder; exit 2 with one line where the request makes no sense."""
    parser = _parser()
    given = vars(parser.parse_args(arguments))
    folder, kind = given.pop("folder"), given.pop("format")
    try:
        panel = beam.Panel(**{name: given.pop(name) for name in vars(beam.Panel())})
        given["pairs"] = tuple(map(tuple, given["pairs"] or records.ONE_PLACE))
        for name in ("zeta", "peaks", "double_hits", "overloads"):
            given[name] = tuple(given[name])
        setup = records.Setup(panel=panel, **given)
        modes, places = records.record(setup)
        plan = files.write(setup, modes, places, folder, kind)
    except (ValueError, OSError) as problem:
        parser.exit(2, f"record_generator: {problem}\n")
    print(f"{plan}: {len(setup.pairs)} place(s), {setup.hits} hit(s) each", file=sys.stderr)


def _parser():
    """Every option of Setup and Panel, with the defaults those have."""
    shown = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog="python -m record_generator", description=__doc__, formatter_class=shown)
    default = records.Setup()
    parser.add_argument("folder", help="where to write; a folder that is not empty is refused")
    parser.add_argument(
        "--format", choices=files.FORMATS, default="csv", help="csv: a file a hit; uff: a file a place (default csv)"
    )
    parser.add_argument("--seed", type=int, default=default.seed, help="of every random number (default 1)")

    piece = parser.add_argument_group("the piece and its constants (defaults: the seed's tables 3 and 9, piece 1)")
    units = {"mass_per_area": "kg/m2", "e_x": "Pa", "g_zx": "Pa"}
    for name, value in vars(default.panel).items():
        piece.add_argument(_flag(name), type=float, default=value, help=f"{units.get(name, 'm')} (default {value:g})")
    piece.add_argument(
        "--zeta",
        type=float,
        nargs="+",
        default=default.zeta,
        help="damping ratios of modes 1, 2, ... (default table 9)",
    )
    piece.add_argument(
        "--zeta-beyond", type=float, default=default.zeta_beyond, help="of all modes after those (default 0.004)"
    )

    where = parser.add_argument_group("places")
    pairs = where.add_mutually_exclusive_group()
    place = {"dest": "pairs", "metavar": ("FORCE_X", "RESPONSE_X"), "type": float, "nargs": 2, "action": "append"}
    pairs.add_argument(
        "--pair", **place, help="one place: x of force and response, m; repeat it for more (default -0.3 0.3)"
    )
    five = "forces at -0.3 -0.21 -0.05 0.13 0.3, response at 0.3"
    pairs.add_argument("--five-places", dest="pairs", action="store_const", const=records.FIVE_PLACES, help=five)

    hit = parser.add_argument_group("hits")
    hit.add_argument("--hits", type=int, default=default.hits, help="hits a place (default 5)")
    hit.add_argument(
        "--peaks", type=float, nargs=2, metavar=("LOW", "HIGH"), default=default.peaks, help="N (default 60 180)"
    )
    hit.add_argument(
        "--pulse", choices=hammer.SHAPES, default=default.pulse, help="shape of the contact (default haversine)"
    )
    hit.add_argument(
        "--pulse-duration", type=float, default=default.pulse_duration, help="s (default 2e-4: force up to 8 kHz)"
    )
    hit.add_argument(
        "--double-hit", dest="double_hits", type=int, nargs="+", default=(), metavar="HIT", help="these hits bounce"
    )
    hit.add_argument(
        "--double-after", type=float, default=default.double_after, help="s between the contacts (default 6e-3)"
    )
    hit.add_argument(
        "--double-part", type=float, default=default.double_part, help="second peak over first (default 0.4)"
    )

    chain = parser.add_argument_group("measuring chain")
    chain.add_argument("--sampling-rate", type=float, default=default.sampling_rate, help="Hz (default 16384)")
    chain.add_argument("--samples", type=int, default=default.samples, help="in a record (default 32768)")
    chain.add_argument(
        "--pre-trigger", type=int, default=default.pre_trigger, help="samples before the hit (default 256)"
    )
    chain.add_argument("--no-anti-alias", dest="anti_alias", action="store_false", help="sample without the low pass")
    chain.add_argument(
        "--noise", type=float, default=default.noise, help="deviation as a part of the channel (default 0.003)"
    )
    chain.add_argument(
        "--noise-of", choices=["rms", "peak"], default=default.noise_of, help="of the channel in each hit (default rms)"
    )
    chain.add_argument(
        "--overload", dest="overloads", type=int, nargs="+", default=(), metavar="HIT", help="these hits are clipped"
    )
    chain.add_argument(
        "--overload-at", type=float, default=default.overload_at, help="range over that hit's peak (default 0.7)"
    )
    chain.add_argument(
        "--sensor-sign", type=int, choices=[1, -1], default=1, help="-1: turned round, declared in test.toml"
    )
    chain.add_argument("--unit", choices=["m/s2", "g"], default=default.unit, help="of the acceleration (g: UFF only)")
    parser.set_defaults(pairs=None)
    return parser


def _flag(name):
    """A field's name as an option."""
    return "--" + name.replace("_", "-")
