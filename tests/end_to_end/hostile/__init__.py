"""The hostile-folder drill's parts: the campaign that is tried and how it is judged (trial), what can be put where
(things), and the ways, by the folder they lie in (ways)."""
