"""The fault drill's parts: what a disturbed campaign is (campaign), how it is disturbed (board, power), what counts as
a loss (tally), and the cases, by what they disturb."""
