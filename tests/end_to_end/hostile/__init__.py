"""Parts of the hostile-folder drill: the tried campaign and its judgement (trial), objects to put into it
(things), and the ways by folder (ways).
"""
