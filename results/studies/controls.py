"""Control variates: sums of mean zero that take scatter away."""
import numpy as np

from studies.estimates import jackknife

FOLDS = 10


def cross_fitted(values, controls, folds=FOLDS):
    """values - controls b, a row of controls for each realisation. The coefficients b of each fold are those of a
    linear regression over the realisations of the others: whatever they are, controls of mean zero leave the mean as
    it is."""
    values, controls = np.asarray(values, float), np.asarray(controls, float)
    fold = np.arange(len(values)) % folds
    found = np.empty_like(values)
    for k in range(folds):
        others, own = fold != k, fold == k
        centred = controls[others] - controls[others].mean(axis=0)
        coefficients = np.linalg.lstsq(centred, values[others] - values[others].mean(), rcond=None)[0]
        found[own] = values[own] - controls[own] @ coefficients
    return found


def variance_ratio(plain, controlled):
    """Variance of one over that of the other, with its standard error by leaving out one realisation at a time. A row
    of averages for each realisation, or one number."""
    plain, controlled = (np.asarray(rows, float).reshape(len(rows), -1) for rows in (plain, controlled))
    return jackknife(lambda chosen: controlled[chosen].var() / plain[chosen].var(), len(plain))
