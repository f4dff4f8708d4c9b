//! Reads and writes PPM; decodes PNG, JPEG and TIFF; saves atomically. Knows only pixels and files.
