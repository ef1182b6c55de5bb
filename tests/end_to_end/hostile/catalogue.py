"""The list of ways in which an engine lies."""
import collections

# Moves the cursor, clears the screen, rings, and reverses the writing direction.
ESCAPE = "\x1b[2J\r\n\x07\u202e"

# place: job, after (the honest end of a job), hello, validate.
# fate: of the seed's try, or of the run:
#   again    blamed, or at least not counted; the seed runs again, and the campaign ends as the honest one
#   taken    nothing is wrong: the campaign ends as the honest one, without blame
#   either   one of the two
#   ends     the run ends with one of `codes`; nothing is stored that the honest campaign lacks
#   refused  the scenes could not be checked: nothing is written
Way = collections.namedtuple("Way", "name place fate codes lie text slow")
WAYS = {"honest": Way("honest", None, "taken", (), None, None, False)}


def way(name, fate="again", place="job", codes=(), text=None, slow=False):
    def register(lie):
        assert name not in WAYS, name
        WAYS[name] = Way(name, place, fate, codes, lie, text, slow)
        return lie

    return register
