"""Mistyped verbs, options, names and values."""
import json

from .night import CAMPAIGN, REAL, SCENE


def verb(night):
    """A verb with two letters swapped"""
    night.write()
    night.types("peclet stauts night.json", 2, ["stauts", "no such verb", "did you mean status?"])
    night.types("peclet --help", 0, ["status"])


def option(night):
    """An option with two letters swapped"""
    night.write()
    night.types("peclet run night.json --wrokers 2", 2, ["--wrokers", "no such option", "did you mean --workers?"])
    night.follows(says=["--workers"])


def file_name(night):
    """A file name with two letters swapped"""
    night.write()
    night.types("peclet run nihgt.json", 2, ["nihgt.json", "no such file", "did you mean night.json?"])
    night.types("peclet status nihgt.json", 2, ["no such file or folder", "did you mean night.json?"])


def point(night):
    """A point that is not in the sweep"""
    night.write()
    night.types("peclet run night.json --quiet > table")
    night.types("peclet explain night.json peclet=3", 2, ["peclet=3", "labels: peclet=1, peclet=2"])
    night.types("peclet explain night.json peclet=2", 0, ["peclet=2"])


def key(night):
    """A key of the scene without one of its letters"""
    scene = {("volume_fracton" if name == "volume_fraction" else name): value for name, value in SCENE.items()}
    night.write(dict(REAL, scene=scene))
    night.types("peclet run night.json", 2, ["night.json", "/scene/volume_fracton", "did you mean volume_fraction?"])
    night.types("sed -i s/fracton/fraction/ night.json && peclet validate night.json", 0, ["night: valid"])


def percent(night):
    """A tolerance of 5, a volume fraction of 45, a confidence of 95"""
    night.write(dict(REAL, target={"relative_tolerance": 5}))
    night.types("peclet run night.json", 2, ["/target/relative_tolerance", "5 % is written 0.05"])
    night.write(dict(REAL, scene=dict(SCENE, volume_fraction=45)))
    night.types("peclet run night.json", 2, ["/scene/volume_fraction", "45 % is written 0.45"])
    night.write(dict(REAL, target={"relative_tolerance": 0.05, "confidence": 95}))
    night.types("peclet run night.json", 2, ["/target/confidence", "95 % is written 0.95"])


def two_seeds(night):
    """A first stop test at two seeds"""
    night.write(dict(CAMPAIGN, realisations={"minimum": 2, "maximum": 100}))
    night.types("peclet run night.json", 2, ["/realisations/minimum: 2", ">= 8"])


def same_point_twice(night):
    """The same value twice in a sweep"""
    night.write(dict(CAMPAIGN, sweep=[{"set": "/peclet", "values": [1, 10, 1.0]}]))
    night.types("peclet run night.json", 2, ["/sweep/0/values/2", "must differ"])


def commas_and_quotes(night):
    """A comma too many, quotation marks from a letter, a comment"""
    text = json.dumps(CAMPAIGN, indent=2)
    night.write(text.replace('"fake_engine"\n', '"fake_engine",\n'))
    night.types("peclet run night.json", 2, ["line", "the comma before it is one too many"])
    night.write(text.replace('"night"', "\u201cnight\u201d"))
    night.types("peclet run night.json", 2, ["line 2", "typographic quotation mark"])
    night.write(text.replace('"sweep"', '# three would do\n  "sweep"'))
    night.types("peclet run night.json", 2, ["line", "comments begin with //"])


def foreign_line_ends(night):
    """A file with a byte-order mark and the line ends of Windows"""
    night.write("\ufeff" + json.dumps(CAMPAIGN, indent=2).replace("\n", "\r\n"))
    night.types("peclet run night.json --quiet", 0, ["2 points: 2 converged"])


CASES = [
    verb,
    option,
    file_name,
    point,
    key,
    percent,
    two_seeds,
    same_point_twice,
    commas_and_quotes,
    foreign_line_ends,
]
SLOW = []
