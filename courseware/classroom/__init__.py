"""For teachers: hands the lessons out without their solutions, takes them back, and gives points.

points             what an exercise is worth, and what an answer earns
assignment_cells   a lesson or a project, its exercises and their cells
model_answers      the model answers, under the names of the students' functions
student_copies     lessons without their solutions, in a folder that works by itself; and solved
rubric             the teacher's page for each lesson: tasks, points, typical mistakes, discussions
leaks              what of the teacher's is looked for in whatever a student gets
nbgrader_course    source notebooks and the configuration of nbgrader
nbgrader_judge     the judge in nbgrader's place
handout            all of it into one folder, at once

submissions        a folder of what students handed in: whose, and what is not read; the class list
sandbox            the walls: bubblewrap around a submission, limits, and a watch on them
inside             the process within the walls: reads the submission and runs its answers
exchange           answers as text that can be read without running anything
self_test          what a hostile answer would try (`attempts.toml`), tried before every grading
judge              one submission judged: answers compared, points, sentences
worlds             the worlds on which a project's function is judged: other seeds, other rooms
grading            all submissions of a folder, each in a process of its own
results            what counts, points, and what a teacher wants to see of the class
pages              the results as pages and tables (`templates/`)
"""
