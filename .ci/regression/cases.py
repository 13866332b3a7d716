"""The cases: what is typed, and what of it is interrupted.

Every case runs in a folder of its own, which bears its name, and leaves its result in `result`
there. `../NAME/` leads to what another case has left, `../inputs/` to the files that are given.
"""

import re
import shlex
from dataclasses import dataclass, field

# Cycles that ship: those that can be steered, and the others.
STEERED = ["low-200", "low-175", "low-165", "hip-10", "least-heat", "efficient"]
UNSTEERED = ["thesis-nominal", "thesis-optimal", "far-200", "far-183", "far-165", "gentle"]
CYCLES = STEERED + UNSTEERED

# Pulls that ship.
GAITS = [
    "nominal",
    "optimal",
    "least-published",
    "least-torque",
    "least-torque-clamped",
    "least-torque-spline",
    "least-weighted-torque",
    "least-peak",
]

SCENES = ["plate-200", "table", "bend", "ramp", "rough-5", "rough-10"]


@dataclass(frozen=True)
class Interruption:
    """A run that is stopped by Ctrl-C, begun again, killed, and begun once more."""

    # The file that the program keeps its work in: when it has changed, there is work to lose.
    kept: str
    # What is typed to go on.
    resume: list[str]
    # The case whose result this one must end in.
    whole: str


@dataclass(frozen=True)
class Case:
    name: str
    arguments: list[str]
    # Whether the program is to refuse it or to fail, so that a misspelt case is noticed.
    refused: bool = False
    interruption: Interruption | None = None
    # Cases whose results this one reads.
    needs: list[str] = field(init=False)

    def __post_init__(self):
        read = re.findall(r"(?:^|\s)\.\./([^/\s]+)", " ".join(self.arguments))
        object.__setattr__(self, "needs", [name for name in read if name != "inputs"])


def case(name, typed, **more):
    return Case(name, shlex.split(typed), **more)


def refusal(name, typed):
    return case(f"refused.{name}", typed, refused=True)


def interrupted(whole, kept, resume=()):
    interruption = Interruption(kept, list(resume), whole.name)
    return Case(f"{whole.name}.interrupted", whole.arguments, interruption=interruption)


def all_cases():
    """Long ones first, so that none is left for the end; none reads what comes after it."""
    cases = [
        *reproductions(),
        *torque_maps(),
        *frontiers(),
        *searches(),
        *passages(),
        *crawls(),
        *exports(),
        *pages(),
        *plans(),
        *costs(),
        *refusals(),
    ]
    names = [one.name for one in cases]
    assert len(names) == len(set(names)), "two cases have one name"
    for index, one in enumerate(cases):
        assert set(one.needs) <= set(names[:index]), f"{one.name} reads what comes after it"
    return cases


def reproductions():
    return [
        case("reproduce", "reproduce --out result"),
        case("reproduce.json", "reproduce --durations 1,5 --out result --json"),
        case("reproduce.robot", "reproduce --durations 0.5 --robot ../inputs/nao --out result"),
    ]


def torque_maps():
    coarse = "--step-deg 10 --theta4-max-deg 10 --out result.csv"
    simulation = case(
        "torque-map.simulation",
        "torque-map build --source simulation --step-deg 5 --theta4-max-deg 10 --out result.csv",
    )
    fine = "../torque-map.statics/result.csv ../torque-map.simulation/result.csv"
    both = "../torque-map.statics-coarse/result.csv ../torque-map.simulation-coarse/result.csv"
    return [
        simulation,
        interrupted(simulation, "result.csv.partial"),
        case("torque-map.statics", "torque-map build --source statics --out result.csv"),
        case("torque-map.statics-coarse", f"torque-map build --source statics {coarse} --json"),
        case("torque-map.simulation-coarse", f"torque-map build --source simulation {coarse} --json"),
        case("torque-map.compare", f"torque-map compare {both}"),
        case("torque-map.compare.json", f"torque-map compare {fine} --worst 50 --json"),
        case("torque-map.plot", "torque-map plot ../torque-map.simulation-coarse/result.csv --out result"),
        case(
            "torque-map.plot-slices",
            "torque-map plot ../torque-map.statics/result.csv --theta3-deg 15,17.5 --out result",
        ),
    ]


def frontiers():
    small = "--runs 1 --budget 40 --out result"
    whole = case("frontier", "crawl frontier --ceilings-mm 165,200 --seed 1 --runs 1 --budget 60 --out result")
    return [
        whole,
        interrupted(whole, "result.checkpoint.json", ["--resume"]),
        case("frontier.heat", f"crawl frontier --ceilings-mm 183 --against heat --seed 7 {small} --json"),
        case("frontier.steerable", f"crawl frontier --ceilings-mm 200 --steerable --seed 2 {small}"),
    ]


def searches():
    table = "--source ../torque-map.statics/result.csv"
    published = f"optimize --objective published {table} --seed 1 --confirm-durations 1 --out result"
    statics = "--source statics --seed 3 --confirm-durations 1 --out result"
    dynamics = "--source dynamics --duration 1 --seed 1 --confirm-durations 1 --out result"
    cycle = "--source cycle --from low-175 --seed 1 --out result"
    searched = [
        case("optimize.map", f"{published} --runs 8 --budget 100000"),
        case("optimize.statics", f"optimize --objective heat {statics} --runs 2 --budget 2500"),
        case("optimize.dynamics", f"optimize --objective torque {dynamics} --budget 1500"),
        case("optimize.cycle", f"optimize --objective heat {cycle} --budget 120"),
    ]
    return [
        *searched,
        *(interrupted(whole, "result.checkpoint.json", ["--resume"]) for whole in searched),
        case("optimize.map-cma-es", f"{published} --solver cma-es --budget 3000 --json"),
        case("optimize.map-genetic", f"{published} --solver ga"),
        case(
            "optimize.map-tolerant",
            f"{published} --budget 3000 --hip-threshold-mm 20 --limit-tolerance-rad 0.05",
        ),
        case(
            "optimize.map-torque",
            f"optimize --objective torque {table} --seed 2 --budget 1000 --confirm-durations 1 --out result",
        ),
        case(
            "optimize.statics-peak",
            f"optimize --objective peak {statics} --solver ga --limits none --budget 600 --json",
        ),
        case(
            "optimize.statics-spline",
            f"optimize --objective heat --per metre {statics} --gait-form bspline:6 --ends free"
            " --solver cma-es --budget 600 --clearance body:5 --name low-heat",
        ),
        case("optimize.dynamics-heat", f"optimize --objective heat {dynamics} --budget 300 --json"),
        case(
            "optimize.dynamics-weights",
            f"optimize --objective torque --weights 1,1,1,5 {dynamics} --budget 300"
            " --from optimal --rate-deg-per-phase none --body-share-of nominal",
        ),
        case(
            "optimize.dynamics-spline",
            f"optimize --objective peak {dynamics} --gait-form bspline:5 --solver cma-es --budget 300",
        ),
        case(
            "optimize.cycle-peak",
            f"optimize --objective peak {cycle} --least-advance-mm 40 --budget 40 --json",
        ),
        case(
            "optimize.cycle-worst",
            f"optimize --objective heat {cycle} --worst-over thesis-nominal --body-share-percent 20"
            " --demanded-shoulder-nm 2 --budget 40",
        ),
        case("optimize.cycle-speed", f"optimize --objective speed {cycle} --ceiling-mm 180 --budget 40"),
        case("optimize.cycle-advance", f"optimize --objective advance {cycle} --steerable --budget 40"),
    ]


def passages():
    return [
        case(
            "under.searched",
            "crawl under --ceiling-mm 163.5 --margin-mm 1 --seed 1 --budget 60 --gait-out result.toml",
        ),
        case("under.250", "crawl under --ceiling-mm 250 --gait-out result.toml"),
        case("under.180", "crawl under --ceiling-mm 180 --json"),
        case("under.172", "crawl under --ceiling-mm 172 --margin-mm 1"),
        case("under.two", "crawl under --ceiling-mm 190 --gait low-175 --gait ../inputs/my-crawl.toml"),
        case("under.impossible", "crawl under --ceiling-mm 100"),
        case("under.impossible.json", "crawl under --ceiling-mm 100 --json"),
    ]


def crawls():
    cases = []
    for gait in CYCLES:
        run = f"crawl run --gait {gait} --cycles 3"
        other = "low-175" if gait == "hip-10" else "hip-10"
        record = "--record result --json"
        cases += [
            case(f"crawl.{gait}.level", f"{run} {record}"),
            case(f"crawl.{gait}.table", f"{run} --scene table {record}"),
            case(f"crawl.{gait}.offsets", f"{run} --joint-offset-deg 1 --seed 3 {record}"),
            case(f"crawl.{gait}.uphill", f"{run} --uphill {other} --slope-deg 8 --seed 5 {record}"),
            case(f"crawl.{gait}.slow", f"{run} --time-scale 1.5 --json"),
            case(f"crawl.{gait}.stiff", f"{run} --servo stiff --json"),
            case(f"crawl.{gait}.fine", f"{run} --time-step-ms 1 --json"),
            case(f"crawl.{gait}.text", f"crawl run --gait {gait} --cycles 1"),
        ]
        steering = {
            "turn": "--turn-deg-per-cycle 10",
            "hold": "--heading-hold --friction-left 0.5 --friction-right 0.9",
            "heading": "--heading-deg -30",
        }
        for name, option in steering.items():
            if gait in STEERED:
                cases.append(case(f"crawl.{gait}.{name}", f"{run} {option} {record}"))
            else:
                cases.append(refusal(f"crawl.{gait}.{name}", f"{run} {option}"))
    low = "crawl run --gait low-175"
    for scene in SCENES:
        cases.append(case(f"crawl.scene.{scene}", f"{low} --scene {scene} --cycles 6 --json"))
    return cases + [
        case(
            "crawl.under-plate",
            f"{low} --ceiling-mm 178 --length-m 0.6 --until-past --heading-hold --friction-left 0.5"
            " --friction-right 0.9 --joint-offset-deg 1 --seed 1 --record result",
        ),
        case("crawl.touching", f"{low} --ceiling-mm 168 --length-m 1 --cycles 6 --record result"),
        case(
            "crawl.ramp",
            "crawl run --gait hip-10 --uphill low-175 --scene ramp --seed 1 --cycles 20 --record result",
        ),
        case("crawl.bend", f"{low} --scene bend --heading-deg 90 --cycles 28 --json"),
        case("crawl.rough", f"{low} --scene rough-10 --heading-hold --cycles 8 --record result --json"),
        case("crawl.downhill", f"{low} --slope-deg -10 --cycles 3 --record result --json"),
        case(
            "crawl.all-at-once",
            "crawl run --gait low-200 --heading-deg 20 --joint-offset-deg 0.5 --seed 9 --slope-deg 2"
            " --friction-left 0.6 --friction-right 0.8 --time-scale 1.2 --servo stiff --time-step-ms 1"
            " --cycles 4 --record result --json",
        ),
        case("crawl.own-cycle", "crawl run --gait ../inputs/my-crawl.toml --cycles 3 --record result --json"),
        case("crawl.own-scene", f"{low} --scene ../inputs/attic.toml --cycles 4 --record result --json"),
        case("crawl.own-robot", f"{low} --robot ../inputs/nao --cycles 3 --record result --json"),
        case(
            "crawl.not-past",
            f"{low} --ceiling-mm 120 --length-m 0.2 --until-past --json",
            refused=True,
        ),
    ]


def exports():
    level, table = "../crawl.low-175.level/result", "../crawl.thesis-nominal.table/result"
    pull = "../reproduce/result/pulls/nominal-5s"
    ending = {"keyframes": "json"}
    cases = [
        case(f"export.{name}.{form}", f"export {run} --format {form} --out result.{ending.get(form, form)}")
        for name, run, forms in [
            ("level", level, ["csv", "npz", "mcap", "urdf", "xar", "keyframes"]),
            ("table", table, ["csv", "npz", "mcap", "urdf", "xar", "keyframes"]),
            ("pull", pull, ["csv", "npz", "mcap", "urdf"]),
        ]
        for form in forms
    ]
    small = "--size 160x90 --fps 5 --to-s 3"
    return cases + [
        case("export.level.gif", f"export {level} --format gif {small} --view follow --out result.gif"),
        case("export.level.webp", f"export {level} --format webp {small} --view side --out result.webp"),
        case("export.table.gif", f"export {table} --format gif {small} --view eye --out result.gif"),
        refusal("export.pull.xar", f"export {pull} --format xar --out result.xar"),
    ]


def pages():
    level, table = "../crawl.low-175.level/result", "../crawl.thesis-nominal.table/result"
    pulls = "../reproduce/result/pulls"
    runs = f"../reproduce/result {level} {table} ../optimize.dynamics/result ../frontier/result"
    plots = "../torque-map.plot/result"
    return [
        case("view.level", f"view {level} --out result.html"),
        case("view.both", f"view {level} --compare {table} --out result.html"),
        case("view.pulls", f"view {pulls}/nominal-5s --compare {pulls}/optimal-5s --out result.html"),
        case("report", f"report {runs} {plots} --out result"),
        case("report.json", f"report {runs} {plots} --out result --json"),
        case("report.page", f"report {level} ../crawl.low-175.turn/result --out result.html --json"),
        case("report.searches", "report ../optimize.map/result ../optimize.cycle/result --out result --json"),
    ]


def plans():
    cases = []
    for gait in GAITS + CYCLES:
        cases += [
            case(f"gait.{gait}", f"gait show {gait} --csv result.csv"),
            case(f"gait.{gait}.json", f"gait show {gait} --json"),
        ]
    return cases + [
        case("gait.duration", "gait show optimal --duration 1.5 --json"),
        case("gait.own", "gait show ../inputs/arched.toml --csv result.csv"),
        case("gait.own.json", "gait show ../inputs/arched.toml --json"),
        case("gait.own-cycle.json", "gait show ../inputs/my-crawl.toml --json"),
        case("gait.own-robot.json", "gait show nominal --robot ../inputs/nao --json"),
        case("robot", "robot check"),
        case("robot.json", "robot check --json"),
        case("robot.folder", "robot check ../inputs/nao"),
        case("robot.folder.json", "robot check ../inputs/nao --json"),
    ]


def costs():
    table = "../torque-map.statics/result.csv"
    cases = [
        case(f"cost.{gait}.{objective}.{name}", f"cost {gait} --objective {objective} --source {source} --json")
        for gait in ["nominal", "optimal", "least-torque-spline"]
        for objective in ["published", "torque", "peak", "heat"]
        for name, source in [("map", table), ("statics", "statics"), ("dynamics", "dynamics")]
        # The published objective looks torques up, of gaits that are polynomials.
        if objective != "published" or (name != "dynamics" and gait != "least-torque-spline")
    ]
    options = {
        "text": "--source statics",
        "metre": "--source statics --per metre --duration 5",
        "weights": "--source dynamics --weights 1,2,3,5 --duration 1",
        "rules": "--source statics --clearance body:5 --limits none --rate-deg-per-phase 50",
        "hip": f"--source {table} --clearance hip:60",
        "from": "--source dynamics --from optimal --body-share-of nominal --duration 2",
        "own-robot": "--source dynamics --robot ../inputs/nao --duration 1",
    }
    cases += [
        case(f"cost.{name}", f"cost least-torque --objective torque {option}")
        for name, option in options.items()
    ]
    return cases + [
        case(
            "cost.published-tolerant",
            f"cost optimal --objective published --source {table} --hip-threshold-mm 20"
            " --limit-tolerance-rad 0.05",
        ),
        case("cost.own", "cost ../inputs/arched.toml --objective heat --source statics --json"),
    ]


def refusals():
    low = "crawl run --gait low-175"
    search = "optimize --objective torque --seed 1 --out result"
    typed = {
        "gait": "gait show gallop",
        "gait.cycle": "crawl run --gait gallop",
        "gait.pull-alone": "crawl run --gait nominal",
        "gait.cost": "cost low-175 --objective torque --source statics",
        "gait.open": "gait show ../inputs/far.toml",
        "gait.limit": "gait show ../inputs/refuse.toml",
        "gait.malformed": "gait show ../inputs/malformed.toml",
        "gait.key": "gait show ../inputs/unknown-key.toml",
        "gait.joint": "gait show ../inputs/unknown-joint.toml",
        "gait.duration": "gait show nominal --duration -5",
        "gait.fast": "crawl run --gait low-175 --time-scale 0.3",
        "scene": f"{low} --scene swamp",
        "scene.key": f"{low} --scene ../inputs/unknown-colour.toml",
        "robot": "robot check nowhere",
        "crawl.cycles": f"{low} --cycles 0",
        "crawl.turn": f"{low} --turn-deg-per-cycle 13",
        "crawl.time-scale": f"{low} --time-scale 0",
        "crawl.offset": f"{low} --joint-offset-deg 11 --seed 1",
        "crawl.friction": f"{low} --friction-left -1 --friction-right 0.5",
        "crawl.slope": f"{low} --slope-deg 90",
        "crawl.step": f"{low} --time-step-ms 5",
        "crawl.no-seed": f"{low} --joint-offset-deg 1",
        "crawl.uphill-no-seed": f"{low} --uphill hip-10",
        "crawl.both": f"{low} --heading-hold --turn-deg-per-cycle 5",
        "crawl.until-past": f"{low} --until-past",
        "under.margin": "crawl under --ceiling-mm 4 --margin-mm 5",
        "under.ceiling": "crawl under --ceiling-mm -1",
        "optimize.source": f"{search} --source nowhere.csv",
        "optimize.objective": "optimize --objective advance --source statics --seed 1 --out result",
        "optimize.budget": f"{search} --source statics --budget 0",
        "optimize.form": f"{search} --source statics --gait-form bspline:1",
        "cost.dynamics": "cost nominal --objective published --source dynamics",
        "cost.spline": "cost least-torque-spline --objective published --source statics",
        "cost.cycle": "cost nominal --objective heat --source cycle",
        "torque-map.step": "torque-map build --source statics --step-deg 7 --out result.csv",
        "torque-map.other": "torque-map compare ../inputs/far.toml ../inputs/far.toml",
        "reproduce.duration": "reproduce --durations 0.25 --out result",
        "export": "export ../inputs --format csv --out result.csv",
        "view": "view ../inputs --out result.html",
        "report": "report ../inputs --out result",
    }
    return [refusal(name, arguments) for name, arguments in typed.items()]
