"""Parts of the fault drill: the disturbed campaign (campaign), the faults (board, power), the losses (tally),
and the cases, by what they disturb.
"""
