#ifndef SEMIHOSTING_H
#define SEMIHOSTING_H

// Ends the program with this exit status.
void end_program(int status);

#endif
