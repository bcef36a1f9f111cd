// The two functions of Zephyr that the application calls.

void k_msleep(int milliseconds);
int printk(const char *format, ...);
