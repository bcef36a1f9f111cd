// Stands in for Arduino's header, to compile the sketch.

#include <stdint.h>

struct Printer {
    void begin(unsigned long);
    void print(const char *);
    void print(uint32_t);
    void println(const char *);
};

extern Printer Serial;
void delay(unsigned long);
void setup();
void loop();
