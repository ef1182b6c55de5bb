#!/bin/sh
# cancel.sh NAME: ends the jobs of this name, waiting or running.
scancel --me --name="$1"
