"""What the papers leave open, built on both methods. Neither method imports anything from here.

six_dof/         paper 1, section 5: all six degrees of freedom, by an annealed and refined filter
lost_and_found/  a start that is not known, and finding the camera again after it was carried away
being_lost       whether the annealed filter still holds the track
look_alikes/     rooms whose objects look alike: poses of two matches, what speaks for each, how sure
several_views    several views over time
compiling        what the first step would wait for, done before
guarded_*        sensor trouble: the one watch, which looks at each frame before a filter uses it
"""

# ruff: noqa: F401 - the public names
from course_lib.beyond.compiling import warm_up
from course_lib.beyond.guarded_depth import GuardedFrame, GuardedLocalizer
from course_lib.beyond.guarded_stereo import GuardedPair, GuardedRig
from course_lib.beyond.look_alikes.consistent import associate_consistent, rank_poses
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis
from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.beyond.lost_and_found.global_search import GlobalSearch, PoseCandidate, PoseCandidates
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.beyond.several_views import Motion, SemanticTracker, Track
from course_lib.beyond.six_dof.calibration import Calibration, CalibrationCheck
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.beyond.six_dof.poses import motion_between
