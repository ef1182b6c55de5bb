"""Imports the names that most drivers of studies use."""
# flake8: noqa: F401,F403
from studies.at_rest import *
from studies.campaigns import *
from studies.command_line import *
from studies.configurations import *
from studies.costs import *
from studies.estimates import *
from studies.figure import *
from studies.fits import *
from studies.published import *
from studies.scenes import *
from studies.tables import *
from studies.verdicts import *
