"""For teachers: hands the lessons out without their solutions, takes them back, and gives points.

points             what an exercise is worth, and what an answer earns
assignment_cells   a lesson or a project, its exercises and their cells
model_answers      the model answers put into the student's stubs
student_copies     lessons without their solutions, in a folder that works by itself; and solved
graded_tests       what an answer is worth, on inputs that a secret seed draws; what its feedback may say
score_worlds       the worlds on which a project's function is graded: other seeds, other rooms
rubric             the teacher's page for each lesson: tasks, points, typical mistakes, discussions
nbgrader_course    source notebooks and the configuration of nbgrader
nbgrader_steps     what nbgrader does here besides its own: nothing forged, nothing failed by a warning
nbgrader_trial     three submissions of a lesson sent through nbgrader: points, and whether anything leaked
handout            all of it into one folder, at once
leaks              what of the teacher's is looked for in whatever a student gets

submissions        a folder of what students handed in: whose, which lesson, and what is not read
needed_code        of a notebook's cells, the statements that one function needs
sandbox            the grader's side of a process that runs one answer and is watched
sandbox_process    the process itself: what happens inside the walls
probe              which of them this machine gives, found by trying
confinement        the walls, by means of the Linux kernel: files, system calls, resources
refusals           what was tried and refused, in words
answers            answers as text that can be read without running anything
packed_arguments   arguments on their way into the sandbox; what can be called stays with the grader
sandboxed_score    a project's last function in the sandbox, in the worlds of a secret seed
judging            one answer run, compared and given its points
grading            all answers, on several processors, whatever happens to one of them
grade_tables       the results as CSV
grade_page         the results as a page
"""
