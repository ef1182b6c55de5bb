"""The list of the ways in which an engine lies."""
import collections

# Moves the cursor, clears the screen, rings, and turns what follows around.
ESCAPE = "\x1b[2J\r\n\x07\u202e"

# place: job, after (the honest end of one), hello, validate.
# fate: what becomes of the seed's try, or of the run:
#   again    it is blamed, or at least does not count; the seed is run again, and the campaign ends as the honest one
#   taken    nothing is wrong with it: the campaign ends as the honest one and nobody is blamed
#   either   one of the two
#   ends     the run ends with one of `codes`; nothing is stored that the honest campaign does not have
#   refused  the scenes could not be judged: nothing is written
Way = collections.namedtuple("Way", "name place fate codes lie text slow")
WAYS = {"honest": Way("honest", None, "taken", (), None, None, False)}


def way(name, fate="again", place="job", codes=(), text=None, slow=False):
    def register(lie):
        assert name not in WAYS, name
        WAYS[name] = Way(name, place, fate, codes, lie, text, slow)
        return lie

    return register
