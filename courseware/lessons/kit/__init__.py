"""What several lessons share.

`predictions` asks for predictions and prints them again beside the results. `exercises` checks answers, `projects`
scores projects, and `statements` says what of a notebook an answer needs. `student_record` keeps predictions and
results, `lesson_progress` counts them, and `show_progress` shows the counts. `display` shows a figure and `scene` a 3D
scene. `panel`, `live_figure` and `progress_bar` are the moving parts. `intervals` prints medians and shares with their
intervals. `corridor_data` and `room_data` load the data of several lessons.
"""
